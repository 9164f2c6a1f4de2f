"""Parameters of the timed-elastic-band controller, by the names of teb_local_planner."""

import math
from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter


@dataclass(frozen=True)
class RobotParameters(Parameters):
    """What the robot can do, and its outline."""

    max_vel_x: float = parameter(0.4, "Largest speed ahead.", unit="m/s", above=0.0)
    max_vel_x_backwards: float = parameter(0.2, "Largest speed backwards.", unit="m/s", above=0.0)
    max_vel_y: float = parameter(0.0, "Largest speed sideways; 0 for a robot with wheels.", unit="m/s", minimum=0.0)
    max_vel_theta: float = parameter(0.3, "Largest turn rate.", unit="rad/s", above=0.0)
    acc_lim_x: float = parameter(0.5, "Largest acceleration ahead.", unit="m/s^2", above=0.0)
    acc_lim_y: float = parameter(0.5, "Largest acceleration sideways.", unit="m/s^2", above=0.0)
    acc_lim_theta: float = parameter(0.5, "Largest angular acceleration.", unit="rad/s^2", above=0.0)
    min_turning_radius: float = parameter(0.0, "Least radius of a curve; 0 to turn on the spot.", unit="m", minimum=0.0)
    use_proportional_saturation: bool = parameter(
        False, "Whether all velocities are reduced by one factor where one is beyond its limit."
    )
    footprint_type: str = parameter(
        "point",
        "Outline by which the distance to obstacles is measured.",
        name="footprint_model.type",
        choices=("point", "circular", "line", "two_circles", "polygon"),
    )
    footprint_radius: float = parameter(0.2, "Of a circular one.", unit="m", above=0.0, name="footprint_model.radius")
    line_start: tuple[float, ...] = parameter(
        (-0.3, 0.0), "Start of a line.", unit="m", name="footprint_model.line_start"
    )
    line_end: tuple[float, ...] = parameter((0.3, 0.0), "End of a line.", unit="m", name="footprint_model.line_end")
    front_offset: float = parameter(
        0.2, "Distance of the front circle's centre.", unit="m", name="footprint_model.front_offset"
    )
    front_radius: float = parameter(
        0.2, "Of the front circle.", unit="m", above=0.0, name="footprint_model.front_radius"
    )
    rear_offset: float = parameter(
        0.2, "Distance of the rear circle's centre, backwards.", unit="m", name="footprint_model.rear_offset"
    )
    rear_radius: float = parameter(0.2, "Of the rear circle.", unit="m", above=0.0, name="footprint_model.rear_radius")
    vertices: str = parameter(
        "[[0.25, -0.05], [0.18, -0.05], [0.18, -0.18], [-0.19, -0.18], [-0.25, 0.0], [-0.19, 0.18], [0.18, 0.18], "
        "[0.18, 0.05], [0.25, 0.05]]",
        "Corners of a polygon [m].",
        name="footprint_model.vertices",
    )


@dataclass(frozen=True)
class TebParameters(RobotParameters):
    """Parameters of the controller."""

    teb_autosize: bool = parameter(True, "Whether poses are added and removed while the band is optimised.")
    dt_ref: float = parameter(0.3, "Wanted time between two poses.", unit="s", above=0.0)
    dt_hysteresis: float = parameter(0.1, "How far from it the time may be.", unit="s", minimum=0.0)
    min_samples: int = parameter(3, "Least number of poses.", minimum=3)
    max_samples: int = parameter(500, "Largest number of poses.", minimum=4)
    global_plan_overwrite_orientation: bool = parameter(
        True, "Whether the band ends along the path where the goal is beyond the look-ahead."
    )
    allow_init_with_backwards_motion: bool = parameter(
        False, "Whether a band to what is behind the robot begins backwards."
    )
    global_plan_viapoint_sep: float = parameter(
        -0.1, "Distance between the points of the path that attract the band; none below 0.", unit="m"
    )
    via_points_ordered: bool = parameter(False, "Whether the band comes by these points in their order.")
    max_global_plan_lookahead_dist: float = parameter(3.0, "Length of the path that is optimised.", unit="m", above=0.0)
    exact_arc_length: bool = parameter(False, "Whether speeds are those on arcs rather than on their chords.")
    force_reinit_new_goal_dist: float = parameter(
        1.0, "How far the end may move before a new band is made.", unit="m", minimum=0.0
    )
    force_reinit_new_goal_angular: float = parameter(
        0.25 * math.pi, "How far the end may turn before a new band is made.", unit="rad", minimum=0.0
    )
    feasibility_check_no_poses: int = parameter(
        5, "Number of poses at the start that are checked for contact; all for -1.", minimum=-1
    )
    feasibility_check_lookahead_distance: float = parameter(
        -1.0, "Distance to which they are checked; as far as they lead below 0.", unit="m"
    )
    min_resolution_collision_check_angular: float = parameter(
        math.pi, "Turn between two poses from which poses between them are checked too.", unit="rad", above=0.0
    )
    control_look_ahead_poses: int = parameter(1, "Number of steps over which the commanded velocity is.", minimum=1)
    free_goal_vel: bool = parameter(False, "Whether the robot may arrive at speed.")
    min_obstacle_dist: float = parameter(0.5, "Wanted distance to obstacles.", unit="m", minimum=0.0)
    inflation_dist: float = parameter(0.6, "Distance at which they begin to matter.", unit="m", minimum=0.0)
    include_costmap_obstacles: bool = parameter(True, "Whether the obstacles of the costmap are avoided.")
    costmap_obstacles_behind_robot_dist: float = parameter(
        1.5, "Distance behind the robot up to which they are.", unit="m", minimum=0.0
    )
    no_inner_iterations: int = parameter(5, "Steps of the solver in each of the following.", minimum=1)
    no_outer_iterations: int = parameter(
        4, "How often poses are added and removed and the band is optimised.", minimum=1
    )
    optimization_activate: bool = parameter(True, "Whether the band is optimised.")
    penalty_epsilon: float = parameter(0.05, "How far within their limits velocities are kept.", minimum=0.0)
    weight_max_vel_x: float = parameter(2.0, "Of speeds beyond their limits.", minimum=0.0)
    weight_max_vel_y: float = parameter(2.0, "Of speeds sideways beyond their limits.", minimum=0.0)
    weight_max_vel_theta: float = parameter(1.0, "Of turn rates beyond their limits.", minimum=0.0)
    weight_acc_lim_x: float = parameter(1.0, "Of accelerations beyond their limits.", minimum=0.0)
    weight_acc_lim_y: float = parameter(1.0, "Of accelerations sideways beyond their limits.", minimum=0.0)
    weight_acc_lim_theta: float = parameter(1.0, "Of angular accelerations beyond their limits.", minimum=0.0)
    weight_kinematics_nh: float = parameter(1000.0, "Of steps that are no arcs.", minimum=0.0)
    weight_kinematics_forward_drive: float = parameter(1.0, "Of steps backwards.", minimum=0.0)
    weight_kinematics_turning_radius: float = parameter(1.0, "Of curves tighter than the turning radius.", minimum=0.0)
    weight_optimaltime: float = parameter(1.0, "Of the time that the way takes.", minimum=0.0)
    weight_shortest_path: float = parameter(0.0, "Of its length.", minimum=0.0)
    weight_obstacle: float = parameter(50.0, "Of being nearer to obstacles than wanted.", minimum=0.0)
    weight_inflation: float = parameter(0.1, "Of being nearer than where they begin to matter.", minimum=0.0)
    weight_viapoint: float = parameter(1.0, "Of the distance to the points of the path.", minimum=0.0)
    weight_prefer_rotdir: float = parameter(50.0, "Of turns in the other direction while it oscillates.", minimum=0.0)
    weight_adapt_factor: float = parameter(
        2.0, "Growth of the weight of obstacles from one round to the next.", minimum=1.0
    )
    obstacle_cost_exponent: float = parameter(1.0, "Exponent of how much distance is missing.", above=0.0)
    enable_homotopy_class_planning: bool = parameter(
        True, "Whether ways on other sides of obstacles are tried as well."
    )
    max_number_classes: int = parameter(4, "Number of ways that are optimised.", minimum=1)
    selection_cost_hysteresis: float = parameter(1.0, "Factor of the cost of the way that was taken last.", above=0.0)
    selection_prefer_initial_plan: float = parameter(0.95, "Factor of the cost of the way along the path.", above=0.0)
    switching_blocking_period: float = parameter(
        0.0, "Time from one change of the way to the next at least.", unit="s", minimum=0.0
    )
    roadmap_graph_area_width: float = parameter(
        5.0, "Width of the area in which other ways are looked for.", unit="m", above=0.0
    )
    obstacle_heading_threshold: float = parameter(
        0.45, "Cosine of the largest angle between them and the direction to the goal.", minimum=0.0, maximum=1.0
    )
    shrink_horizon_backup: bool = parameter(True, "Whether half of the path is optimised after a failure.")
    shrink_horizon_min_duration: float = parameter(10.0, "For how long.", unit="s", minimum=0.0)
    oscillation_recovery: bool = parameter(True, "Whether one direction of turning is preferred after an oscillation.")
    oscillation_v_eps: float = parameter(
        0.1, "Mean speed, by the largest, below which the robot oscillates.", minimum=0.0
    )
    oscillation_omega_eps: float = parameter(
        0.1, "Mean turn rate, by the largest, below which it oscillates.", minimum=0.0
    )
    oscillation_recovery_min_duration: float = parameter(
        10.0, "For how long the direction is preferred.", unit="s", minimum=0.0
    )
    oscillation_filter_duration: float = parameter(10.0, "Over how long the means are taken.", unit="s", above=0.0)
