"""The controller: it arrives, keeps its limits, passes obstacles, and refuses what it cannot drive."""

import math

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError
from daidalos.common.pose2 import compose, move_along_arc, wrap
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.teb_controller import TebController, TebParameters
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl

from ..scenes import control, ground, line

ROBOT = Footprint.circle(0.2)
WALL = [(1.2, y) for y in np.arange(-0.3, 0.31, 0.05)]


def teb(footprint=ROBOT, **parameters):
    given = {"min_obstacle_dist": 0.3} | parameters
    return TebController(TebParameters(**given), NavigationContext(footprint=footprint, frequency=20.0))


def drive(controller, path, costmap=None, pose=(0.0, 0.0, 0.0), steps=600):
    """Poses and commands of a robot that obeys at once, until it is at the goal."""
    costmap = ground() if costmap is None else costmap
    poses, commands = [np.array(pose, dtype=float)], [np.zeros(3)]
    for _ in range(steps):
        nearest = int(np.argmin(np.hypot(*(path - poses[-1])[:, :2].T)))
        given = control(path[nearest:], costmap, poses[-1], commands[-1])
        commands.append(controller.compute_velocity_commands(given))
        poses.append(move_along_arc(poses[-1], commands[-1][0] * 0.05, commands[-1][2] * 0.05))
        to_goal = path[-1] - poses[-1]
        if math.hypot(*to_goal[:2]) < 0.1 and abs(wrap(to_goal[2])) < 0.1:
            return np.array(poses), np.array(commands)
    raise AssertionError(f"not there after {steps} steps: {poses[-1]}")


def distance_to_wall(poses):
    return np.hypot(poses[:, 0] - 1.2, poses[:, 1] - np.clip(poses[:, 1], -0.3, 0.3)).min()


@pytest.mark.slow
def test_it_drives_straight_at_its_largest_speed_and_stops():
    poses, commands = drive(teb(), line((2.5, 0.0)))
    assert np.abs(poses[:, 1]).max() < 0.01
    assert commands[:, 0].max() == pytest.approx(0.4, abs=0.01)
    assert len(poses) * 0.05 < 1.2 * (2.5 / 0.4 + 0.4 / 0.5)


@pytest.mark.slow
@pytest.mark.parametrize("end", [(0.0, 2.0), (-2.0, 0.5)])
def test_it_turns_to_what_is_beside_and_behind(end):
    _, commands = drive(teb(max_vel_theta=1.0, acc_lim_theta=2.0), line(end))
    assert np.abs(commands[:, 2]).max() <= 1.0
    assert commands[:, 0].min() >= -0.2
    assert np.abs(commands[:, 1]).max() == 0.0


@pytest.mark.slow
def test_an_obstacle_on_the_path_is_passed_at_its_distance():
    poses, _ = drive(teb(), line((2.5, 0.0)), ground(WALL))
    assert distance_to_wall(poses) > 0.25


@pytest.mark.slow
def test_the_nearer_side_is_taken_and_kept():
    wall = [(1.2, y) for y in np.arange(-0.6, 0.21, 0.05)]
    poses, _ = drive(teb(), line((2.5, 0.0)), ground(wall))
    assert poses[:, 1].max() > 0.3
    assert poses[:, 1].min() > -0.1


def test_other_ways_are_optimised_only_where_it_is_wanted():
    with_others, alone = teb(), teb(enable_homotopy_class_planning=False)
    path = np.concatenate([line((1.2, 0.7)), line((2.5, 0.0), (1.2, 0.7))[1:]])
    for controller in (with_others, alone):
        controller.compute_velocity_commands(control(path, ground(WALL)))
    assert len(with_others.bands) == 2
    assert len(alone.bands) == 1
    few = teb(max_number_classes=1)
    few.compute_velocity_commands(control(path, ground(WALL)))
    assert len(few.bands) == 1


def test_a_robot_between_obstacles_refuses_and_then_looks_less_far():
    around = [(0.3 * math.cos(a), 0.3 * math.sin(a)) for a in np.linspace(0.0, 2.0 * math.pi, 60)]
    controller = teb()
    with pytest.raises(NoValidControl, match="touches an obstacle"):
        controller.compute_velocity_commands(control(line((2.0, 0.0)), ground(around)))
    controller.compute_velocity_commands(control(line((2.0, 0.0))))
    assert controller.bands[0].poses[-1, 0] == pytest.approx(1.5, abs=0.06)  # half of the look-ahead
    bold = teb(shrink_horizon_backup=False)
    with pytest.raises(NoValidControl):
        bold.compute_velocity_commands(control(line((2.0, 0.0)), ground(around)))
    bold.compute_velocity_commands(control(line((2.0, 0.0))))
    assert bold.bands[0].poses[-1, 0] == pytest.approx(2.0, abs=0.01)


def test_a_robot_that_touches_something_drives_away_from_it():
    beside = ground([(-0.15, 0.0)])
    controller = teb(min_obstacle_dist=0.1)
    assert controller.compute_velocity_commands(control(line((2.0, 0.0)), beside))[0] > 0.0
    with pytest.raises(NoValidControl):
        controller.compute_velocity_commands(control(line((2.0, 0.0)), ground([(0.15, 0.0)])))


def first_command(given=None, **parameters):
    return teb(**parameters).compute_velocity_commands(given or control(line((2.0, 0.5), (0.0, 0.0))))


def test_the_speed_limit_acts():
    controller = teb()
    controller.set_speed_limit(50.0, percentage=True)
    _, commands = drive(controller, line((1.0, 0.0)))
    assert commands[:, 0].max() <= 0.2
    controller.set_speed_limit(0.1, percentage=False)
    assert controller.compute_velocity_commands(control(line((1.0, 0.0))))[0] <= 0.1
    controller.set_speed_limit(0.0, percentage=False)
    _, commands = drive(controller, line((2.5, 0.0)))
    assert commands[:, 0].max() > 0.3


@pytest.mark.parametrize(
    "changes",
    [
        {"dt_ref": 0.6},
        {"teb_autosize": False},
        {"exact_arc_length": True},
        {"optimization_activate": False},
        {"no_outer_iterations": 1},
        {"no_inner_iterations": 1},
        {"max_vel_theta": 1.0},
        {"acc_lim_x": 2.0},
        {"acc_lim_theta": 2.0},
        {"control_look_ahead_poses": 4},
        {"weight_kinematics_nh": 1.0},
        {"weight_optimaltime": 5.0},
        {"weight_shortest_path": 20.0},
        {"weight_max_vel_x": 200.0},
        {"weight_max_vel_theta": 200.0},
        {"weight_acc_lim_x": 100.0},
        {"weight_acc_lim_theta": 100.0},
        {"penalty_epsilon": 0.2},
        {"min_turning_radius": 2.0},
        {"max_global_plan_lookahead_dist": 0.7},
        {"global_plan_viapoint_sep": 0.3},
    ],
)
def test_parameters_act(changes):
    path = np.concatenate([line((0.8, 0.5)), line((2.0, 0.0), (0.8, 0.5))[1:]])
    plain, changed = (first_command(control(path), **given) for given in ({}, changes))
    assert np.abs(changed - plain).max() > 1e-9


def beside_obstacle(**parameters):
    controller = teb(**parameters)
    controller.compute_velocity_commands(control(line((2.0, 0.0)), ground([(1.0, 0.35)])))
    band = controller.bands[0].poses
    return np.hypot(*(band[:, :2] - (1.0, 0.35)).T).min()


def test_distances_to_obstacles_act():
    plain = beside_obstacle()
    assert plain > 0.3
    assert beside_obstacle(min_obstacle_dist=0.6) > plain + 0.1
    assert beside_obstacle(footprint_type="circular", footprint_radius=0.2) > plain + 0.05
    assert beside_obstacle(footprint_type="two_circles", front_radius=0.3, rear_radius=0.3) > plain + 0.1
    assert beside_obstacle(footprint_type="polygon") > plain + 0.02
    assert beside_obstacle(footprint_type="line", line_start=(0.0, -0.2), line_end=(0.0, 0.2)) > plain + 0.05
    assert beside_obstacle(include_costmap_obstacles=False) == pytest.approx(0.35, abs=0.06)


@pytest.mark.parametrize(
    "wrong", [{"footprint_type": "polygon", "vertices": "[[0.1, 0.2]"}, {"footprint_type": "line", "line_end": (1.0,)}]
)
def test_outlines_that_are_none_are_refused(wrong):
    with pytest.raises(ParameterError, match=r"footprint_model\.\w+' must be points of two numbers"):
        teb(**wrong)


def test_a_holonomic_robot_goes_sideways():
    controller = teb(max_vel_y=0.4, max_vel_theta=0.1)
    pose, velocity, path = np.zeros(3), np.zeros(3), line((0.0, 1.0), heading=0.0)
    for _ in range(200):
        nearest = int(np.argmin(np.hypot(*(path - pose)[:, :2].T)))
        velocity = controller.compute_velocity_commands(control(path[nearest:], None, pose, velocity))
        pose = compose(pose, 0.05 * velocity)
        if math.hypot(*(path[-1] - pose)[:2]) < 0.1:
            break
    assert pose[:2] == pytest.approx([0.0, 1.0], abs=0.1)
    assert abs(pose[2]) < 0.3


def test_commands_beyond_their_limits_are_scaled_together_where_wanted():
    controller, scaled = teb(), teb(use_proportional_saturation=True)
    wanted = np.array([0.8, 0.0, 0.3])
    assert controller._saturated(wanted) == pytest.approx([0.4, 0.0, 0.3])
    assert scaled._saturated(wanted) == pytest.approx([0.4, 0.0, 0.15])


def test_turning_to_and_fro_ends_in_one_direction():
    controller = teb(oscillation_filter_duration=1.0)
    for cycle in range(60):
        controller._cycles = cycle
        controller._watch_for_oscillation(np.array([0.0, 0.0, 0.3 if cycle // 5 % 2 else -0.3]))
    assert controller._direction != 0.0
    assert controller._limits()[-1] == controller._direction
    calm = teb(oscillation_filter_duration=1.0, oscillation_recovery=False)
    for cycle in range(60):
        calm._cycles = cycle
        calm._watch_for_oscillation(np.array([0.0, 0.0, 0.3 if cycle // 5 % 2 else -0.3]))
    assert calm._limits()[-1] == 0.0
