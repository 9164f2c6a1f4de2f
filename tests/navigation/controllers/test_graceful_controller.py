"""Graceful motion: what it drives to, how it turns, and what it avoids."""

import math

import numpy as np
import pytest

from daidalos.common.pose2 import move_along_arc, wrap
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.graceful_controller import GracefulController, GracefulParameters
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl

from .scenes import control, ground, line

ROBOT = Footprint.circle(0.2)
BOX = Footprint.of_corners(np.array([[0.2, 0.15], [0.2, -0.15], [-0.2, -0.15], [-0.2, 0.15]]))


def graceful(footprint=ROBOT, **parameters):
    return GracefulController(GracefulParameters(**parameters), NavigationContext(footprint=footprint))


def command(given, footprint=ROBOT, **parameters):
    return graceful(footprint, **parameters).compute_velocity_commands(given)


def drive(controller, path, pose=(0.0, 0.0, 0.0), costmap=None, steps=600, tolerance=0.1):
    """Poses of a robot that obeys at once."""
    poses = [np.array(pose, dtype=float)]
    costmap = ground() if costmap is None else costmap
    for _ in range(steps):
        nearest = int(np.argmin(np.hypot(*(path - poses[-1])[:, :2].T)))
        given = control(path[nearest:], costmap, poses[-1], xy_goal_tolerance=tolerance)
        velocity = controller.compute_velocity_commands(given)
        assert velocity[1] == 0.0
        poses.append(move_along_arc(poses[-1], velocity[0] * 0.05, velocity[2] * 0.05))
        to_goal = path[-1] - poses[-1]
        if math.hypot(*to_goal[:2]) < tolerance and abs(wrap(to_goal[2])) < 0.05:
            return np.array(poses)
    raise AssertionError(f"not there after {steps} steps: {poses[-1]}")


def test_straight_ahead_the_speed_falls_with_the_distance_of_the_target():
    speed, _, turn = command(control(line((3.0, 0.0))), slowdown_radius=0.5, initial_rotation=False)
    assert (speed, turn) == pytest.approx((0.5, 0.0))
    assert command(control(line((3.0, 0.0))), slowdown_radius=2.0)[0] == pytest.approx(0.25)
    braking = command(control(line((3.0, 0.0))), slowdown_radius=0.0, deceleration_max=0.02)
    assert braking[0] == pytest.approx(math.sqrt(2.0 * 1.0 * 0.02))


@pytest.mark.parametrize(
    ("more", "direction"), [({"k_delta": 3.0}, 1), ({"beta": 2.0}, -1), ({"v_angular_max": 0.2}, -1)]
)
def test_gains_of_the_law_act(more, direction):
    given = control(line((3.0, 0.3), (0.0, 0.3)))
    plain, changed = command(given), command(given, **more)
    if "k_delta" in more:
        assert changed[2] / changed[0] > plain[2] / plain[0]
    else:
        assert changed[0] < plain[0]
        assert changed[2] / changed[0] == pytest.approx(plain[2] / plain[0])


def test_the_look_ahead_chooses_the_target():
    """The path bends off to the left: a target farther along it is farther to the left."""
    bend = np.concatenate([line((0.5, 0.0)), line((0.5, 2.0), (0.5, 0.05))])
    near, far = (command(control(bend), max_lookahead=reach, initial_rotation=False) for reach in (0.6, 1.5))
    assert far[2] / far[0] > near[2] / near[0]


def test_it_turns_on_the_spot_at_the_start_until_the_path_is_ahead():
    controller = graceful()
    behind = control(line((-2.0, 0.5)))
    speed, _, turn = controller.compute_velocity_commands(behind)
    assert speed == 0.0
    assert turn == pytest.approx(1.0)
    nearly = control(line((2.0, 0.0)), pose=(0.0, 0.0, -0.8))
    assert controller.compute_velocity_commands(nearly) == pytest.approx([0.0, 0.0, 0.4])
    assert controller.compute_velocity_commands(control(line((2.0, 0.0)), pose=(0.0, 0.0, -0.7)))[0] > 0.0
    assert controller.compute_velocity_commands(behind)[0] > 0.0
    controller.reset()
    assert controller.compute_velocity_commands(behind)[0] == 0.0
    assert command(behind, initial_rotation=False)[0] > 0.0
    assert command(nearly, initial_rotation_tolerance=0.9)[0] > 0.0


def test_turns_on_the_spot_are_neither_too_slow_nor_too_fast():
    at_goal = [control(line((0.05, 0.0), heading=heading)) for heading in (0.2, 1.0, 3.0)]
    assert [command(given)[2] for given in at_goal] == pytest.approx([0.25, 0.5, 1.0])
    assert command(at_goal[0], v_angular_min_in_place=0.1)[2] == pytest.approx(0.1)
    assert command(at_goal[1], rotation_scaling_factor=0.3)[2] == pytest.approx(0.3)


def test_it_backs_up_where_it_may():
    given = control(line((-2.0, 0.0)))
    speed, _, turn = command(given, initial_rotation=False, allow_backward=True)
    assert speed < 0.0
    assert turn == pytest.approx(0.0, abs=1e-6)
    warnings = []
    context = NavigationContext(footprint=ROBOT, warn=warnings.append)
    both = GracefulController(GracefulParameters(allow_backward=True), context)
    assert both.compute_velocity_commands(given)[0] == 0.0
    assert warnings == ["allow_backward is ignored, as initial_rotation is true"]


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (0.0, 0.0, 2.5), (0.0, -0.2, -1.0)])
@pytest.mark.parametrize("heading", [0.0, -1.5, 3.0])
def test_it_arrives_and_turns_as_the_goal_does(start, heading):
    poses = drive(graceful(), line((1.8, 0.6), heading=heading), start)
    assert np.abs(np.diff(poses[:, 2])).max() <= 1.0 * 0.05 + 1e-9


def test_without_a_final_rotation_it_arrives_on_a_curve():
    path = line((1.8, 0.0), heading=1.0)
    ends = [drive(graceful(prefer_final_rotation=prefer), path)[:, 1].min() for prefer in (True, False)]
    assert ends[0] == pytest.approx(0.0, abs=0.03)
    assert ends[1] < ends[0] - 0.05


def test_it_drives_backwards_to_a_goal_behind():
    controller = graceful(initial_rotation=False, allow_backward=True)
    poses = drive(controller, line((-1.5, 0.2), heading=0.0))
    assert np.abs(poses[:, 2]).max() < 1.0


def test_an_obstacle_makes_the_target_nearer_and_one_at_the_robot_is_refused():
    path = line((3.0, 0.0))
    free = command(control(path), slowdown_radius=2.0)[0]
    ahead = control(path, ground([(1.1, 0.0)]))
    assert 0.0 < command(ahead, slowdown_radius=2.0)[0] < free
    with pytest.raises(
        NoValidControl, match=r"each curve to a pose of the path within 1 m from \(0.00, 0.00\) touches"
    ):
        command(control(path, ground([(0.35, 0.0)])))
    assert command(control(path, ground([(0.35, 0.0)])), use_collision_detection=False)[0] > 0.0
    with pytest.raises(NoValidControl):
        command(control(path, ground([(0.8, 0.0)])), min_lookahead=0.8)


def test_a_turn_that_touches_is_not_made():
    """A box beside whose front is a post: it cannot turn left."""
    post = ground([(0.0, 0.22)])
    with pytest.raises(NoValidControl):
        command(control(line((0.0, 2.0)), post), BOX)
    assert command(control(line((0.0, 2.0)), post), BOX, use_collision_detection=False)[2] > 0.0
    turn = control(line((0.05, 0.0), heading=3.1), post)
    assert command(turn, BOX, in_place_collision_resolution=9.0)[2] > 0.0
    assert command(turn, BOX)[0] > 0.0, "it drives on instead"


def test_a_fast_robot_keeps_away_farther():
    """The enlarged box touches posts beside the path, so that the robot goes at the speed of the plain one."""
    posts = [(x, side) for x in np.arange(-0.5, 2.0, 0.05) for side in (-0.21, 0.21)]
    lane = control(line((1.9, 0.0)), ground(posts))
    fast = {"slowdown_radius": 0.3, "v_linear_max": 1.0}
    assert command(lane, BOX, **fast, footprint_scaling_factor=0.0)[0] == pytest.approx(1.0)
    scaled = command(lane, BOX, **fast, footprint_scaling_factor=1.0)[0]
    assert 0.5 <= scaled < 0.8
    finer = command(lane, BOX, **fast, footprint_scaling_factor=1.0, footprint_scaling_step=0.02)[0]
    assert finer >= scaled
    assert command(lane, BOX, **fast, footprint_scaling_factor=1.0, footprint_scaling_linear_vel=0.1)[0] < scaled


def test_near_the_goal_a_way_with_lower_costs_is_searched():
    path, costmap = line((0.8, 0.0)), ground([(0.4, 0.3)])
    plain = command(control(path, costmap), obstacle_cost_margin=0)
    assert plain[2] == pytest.approx(0.0, abs=1e-6)
    controller = graceful(obstacle_cost_margin=100, final_rotation_search_step=0.3)
    given = control(path, costmap)
    first = controller.compute_velocity_commands(given)
    assert abs(first[2]) > 0.01
    assert controller.compute_velocity_commands(given) == pytest.approx(first)


def test_speed_limits_and_their_end():
    controller = graceful(slowdown_radius=0.5)
    given = control(line((3.0, 0.0)))
    for limit, percentage, speed in ((50.0, True, 0.25), (0.2, False, 0.2), (0.0, False, 0.5), (200.0, True, 0.5)):
        controller.set_speed_limit(limit, percentage=percentage)
        assert controller.compute_velocity_commands(given)[0] == pytest.approx(speed)
    controller.set_speed_limit(50.0, percentage=True)
    assert controller.compute_velocity_commands(control(line((0.05, 0.0), heading=3.0)))[2] == pytest.approx(0.5)


def test_a_path_without_headings_is_followed():
    path = line((3.0, 0.3), (0.0, 0.3))
    path[:, 2] = -2.0
    assert command(control(path))[2] > 0.0
