"""Planners and controllers of ROS 1 with their successors, and their parameters by both names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from daidalos.common.parameters import ParameterError, leaves

Rename = str | tuple[str, ...] | None


@dataclass(frozen=True)
class Successor:
    """Plugin that stands for one of ROS 1.

    Attributes
    ----------
    plugin : str
        Its name.
    renamed : mapping
        New names of parameters, or several; None for those that have no effect. Others keep their names.
    defaults : mapping
        Values that differ from the plugin's defaults.
    """

    plugin: str
    renamed: Mapping[str, Rename] = field(default_factory=dict)
    defaults: Mapping[str, Any] = field(default_factory=dict)


_NOT_POTENTIAL: dict[str, Rename] = dict.fromkeys(
    (
        "use_quadratic", "use_grid_path", "old_navfn_behavior", "visualize_potential", "publish_potential",
        "lethal_cost", "neutral_cost", "cost_factor", "publish_scale", "orientation_mode", "orientation_window_size",
        "outline_map", "planner_window_x", "planner_window_y", "planner_costmap_publish_frequency",
    )
)  # fmt: skip
PLANNERS = {
    "navfn/NavfnROS": Successor(
        "nav2_navfn_planner::NavfnPlanner", {"default_tolerance": "tolerance", **_NOT_POTENTIAL}, {"tolerance": 0.0}
    ),
    "global_planner/GlobalPlanner": Successor(
        "nav2_navfn_planner::NavfnPlanner",
        {"default_tolerance": "tolerance", "use_dijkstra": "use_dijkstra", **_NOT_POTENTIAL},
        {"tolerance": 0.0},
    ),
}
_ARCS: dict[str, Rename] = {
    "max_vel_trans": "max_speed_xy",
    "max_trans_vel": "max_speed_xy",
    "min_vel_trans": "min_speed_xy",
    "min_trans_vel": "min_speed_xy",
    "max_rot_vel": "max_vel_theta",
    "min_rot_vel": "min_speed_theta",
    "min_vel_theta": "min_speed_theta",
    "acc_lim_th": "acc_lim_theta",
    "acc_lim_rot": "acc_lim_theta",
    "vth_samples": "vtheta_samples",
    "path_distance_bias": ("PathDist.scale", "PathAlign.scale"),
    "pdist_scale": ("PathDist.scale", "PathAlign.scale"),
    "goal_distance_bias": ("GoalDist.scale", "GoalAlign.scale"),
    "gdist_scale": ("GoalDist.scale", "GoalAlign.scale"),
    "occdist_scale": "BaseObstacle.scale",
    "sim_granularity": "linear_granularity",
    "angular_sim_granularity": "angular_granularity",
    **dict.fromkeys(
        (
            "holonomic_robot", "use_dwa", "dwa", "meter_scoring", "publish_cost_grid_pc", "publish_traj_pc",
            "scaling_speed", "max_scaling_factor", "stop_time_buffer", "forward_point_distance", "prune_plan",
            "oscillation_reset_dist", "oscillation_reset_angle", "escape_vel", "escape_reset_dist",
            "escape_reset_theta", "heading_lookahead", "heading_scoring", "heading_scoring_timestep", "global_frame_id",
            "min_in_place_vel_theta", "in_place_vel_theta", "use_shortest_rotation", "y_vels", "theta_stopped_vel",
            "rot_stopped_vel", "sim_period", "controller_frequency",
        )
    ),
}  # fmt: skip
_ARC_DEFAULTS = {
    "max_vel_x": 0.55, "max_speed_xy": 0.55, "max_vel_theta": 1.0, "acc_lim_x": 2.5, "acc_lim_theta": 3.2,
    "decel_lim_x": -2.5, "decel_lim_theta": -3.2, "min_vel_x": 0.0,
}  # fmt: skip
CONTROLLERS = {
    "teb_local_planner/TebLocalPlannerROS": Successor("teb_local_planner::TebLocalPlannerROS"),
    "dwa_local_planner/DWAPlannerROS": Successor("dwb_core::DWBLocalPlanner", _ARCS, _ARC_DEFAULTS),
    "base_local_planner/TrajectoryPlannerROS": Successor("dwb_core::DWBLocalPlanner", _ARCS, _ARC_DEFAULTS),
}
CHECKER: dict[str, str] = {
    "xy_goal_tolerance": "xy_goal_tolerance",
    "yaw_goal_tolerance": "yaw_goal_tolerance",
    "latch_xy_goal_tolerance": "stateful",
}
"""Parameters of controllers that are those of the goal checker now."""
GOAL_DEFAULTS = {
    "TebLocalPlannerROS": {"xy_goal_tolerance": 0.2, "yaw_goal_tolerance": 0.2, "stateful": False},
    "DWAPlannerROS": {"xy_goal_tolerance": 0.1, "yaw_goal_tolerance": 0.1, "stateful": False},
    "TrajectoryPlannerROS": {"xy_goal_tolerance": 0.1, "yaw_goal_tolerance": 0.05, "stateful": False},
}
"""Defaults of these, by the name of the controller in ROS 1."""


def typed(kind: type | None, values: Mapping[str, Any], place: str) -> dict[str, Any]:
    """Return values in the types of a class of parameters: ROS 1 takes integers where there are floats.

    Raises
    ------
    ParameterError
        A value is of another type.
    """
    known = {leaf.name: leaf for leaf in leaves(kind)} if kind is not None else {}
    found = {}
    for name, value in values.items():
        try:
            found[name] = known[name].typed(value) if name in known else value
        except ParameterError as error:
            raise ParameterError(f"{place}.{name}", error.problem) from None
    return {name: list(value) if isinstance(value, tuple) else value for name, value in found.items()}
