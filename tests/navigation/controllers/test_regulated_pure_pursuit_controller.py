"""Pure pursuit: arcs from geometry, and what regulates their speed."""

import math

import numpy as np
import pytest

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.plan_ahead import PlanAhead
from daidalos.navigation.controllers.regulated_pure_pursuit_controller import (
    RegulatedPurePursuitController,
    RegulatedPurePursuitParameters,
)
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl

from .scenes import control, ground, line

ROBOT = Footprint.circle(0.2)
MOVING = (0.5, 0.0, 0.0)


def drive(path, **more):
    return RegulatedPurePursuitController(None, NavigationContext(footprint=ROBOT)).compute_velocity_commands(
        control(path, **more)
    )


def test_straight_ahead_at_full_speed():
    velocity = drive(line((3.0, 0.0)), velocity=MOVING)
    assert velocity == pytest.approx([0.5, 0.0, 0.0])


def test_the_arc_meets_the_carrot():
    path = line((3.0, 0.5), (0.0, 0.5))
    velocity = drive(path, velocity=MOVING)
    # The carrot is where the path leaves the circle of the look-ahead distance, 0.5 m/s * 1.5 s.
    x = math.sqrt(0.75**2 - 0.5**2)
    assert velocity[2] / velocity[0] == pytest.approx(2.0 * 0.5 / 0.75**2)
    radius = velocity[0] / velocity[2]
    assert math.hypot(x, 0.5 - radius) == pytest.approx(radius)


def test_tight_arcs_are_slow():
    wide, tight = (drive(line((3.0, y), (0.0, y)), velocity=MOVING)[0] for y in (0.1, 0.5))
    assert tight < wide


def test_acceleration_is_limited():
    assert drive(line((3.0, 0.0)))[0] == pytest.approx(2.5 * 0.05)


def test_narrow_places_are_slow():
    beside = [(x, 0.4) for x in np.arange(-1.0, 3.0, 0.05)]
    assert drive(line((3.0, 0.0)), costmap=ground(beside), velocity=MOVING)[0] < 0.45


def test_near_the_goal_it_is_slow():
    path = line((0.3, 0.0))
    velocity = RegulatedPurePursuitController(
        RegulatedPurePursuitParameters(max_linear_accel=100.0), NavigationContext(footprint=ROBOT)
    )
    assert velocity.compute_velocity_commands(control(path, velocity=MOVING))[0] == pytest.approx(0.25, abs=0.02)


def test_a_path_to_the_side_begins_with_a_turn():
    velocity = drive(line((0.0, 2.0)))
    assert velocity[0] == 0.0
    assert velocity[2] > 0.0


def test_a_turn_goes_on_until_the_path_is_ahead():
    controller = RegulatedPurePursuitController(None, NavigationContext(footprint=ROBOT))
    assert controller.compute_velocity_commands(control(line((0.0, 2.0))))[0] == 0.0
    nearly = control(line((0.0, 2.0)), pose=(0.0, 0.0, math.pi / 2 - 0.4))
    assert controller.compute_velocity_commands(nearly)[0] == 0.0
    fresh = RegulatedPurePursuitController(None, NavigationContext(footprint=ROBOT))
    assert fresh.compute_velocity_commands(nearly)[0] > 0.0


def test_at_the_goal_it_turns_as_the_goal_does():
    velocity = drive(line((0.05, 0.0), heading=-1.0))
    assert velocity[0] == 0.0
    assert velocity[2] < 0.0


def test_an_obstacle_on_the_arc_is_refused_and_one_beyond_the_carrot_is_not():
    path = line((3.0, 0.0))
    with pytest.raises(NoValidControl, match="obstacle is in the way"):
        drive(path, costmap=ground([(0.5, 0.0)]), velocity=MOVING)
    assert drive(path, costmap=ground([(1.4, 0.0)]), velocity=MOVING)[0] > 0.0


def test_a_robot_that_touches_already_may_drive_away():
    assert drive(line((3.0, 0.0)), costmap=ground([(-0.15, 0.0)]), velocity=MOVING)[0] > 0.0


def test_speed_limits_and_their_end():
    controller = RegulatedPurePursuitController(None, NavigationContext(footprint=ROBOT))
    given = control(line((3.0, 0.0)), velocity=(0.2, 0.0, 0.0))
    controller.set_speed_limit(50.0, percentage=True)
    assert controller.compute_velocity_commands(given)[0] == pytest.approx(0.25)
    controller.set_speed_limit(0.1, percentage=False)
    assert controller.compute_velocity_commands(given)[0] == pytest.approx(0.1)
    controller.set_speed_limit(0.0, percentage=False)
    assert controller.compute_velocity_commands(given)[0] > 0.3


def regulated(**more):
    return RegulatedPurePursuitController(
        RegulatedPurePursuitParameters(use_rotate_to_heading=False, **more), NavigationContext(footprint=ROBOT)
    )


def test_a_path_behind_is_driven_backwards_where_that_is_allowed():
    behind = control(line((-3.0, 0.5), (0.0, 0.5), heading=0.0), velocity=(-0.5, 0.0, 0.0))
    velocity = regulated(allow_reversing=True).compute_velocity_commands(behind)
    assert velocity[0] < 0.0
    assert velocity[2] / velocity[0] == pytest.approx(2.0 * 0.5 / 0.75**2)
    assert regulated().compute_velocity_commands(control(behind.path))[0] > 0.0


def test_a_cusp_is_driven_to_before_the_robot_reverses():
    ahead, back = line((1.0, 0.0)), line((-1.0, 0.0), (1.0, 0.0), heading=0.0)[1:]
    back[:, 2] = 0.0
    path, controller, handler = np.concatenate([ahead, back]), regulated(allow_reversing=True), PlanAhead()
    handler.set_plan(path)
    pose, velocity, farthest = np.zeros(3), np.zeros(3), 0.0
    for _ in range(200):
        seen, _, left = handler.ahead(pose, np.zeros(3), controller.look_ahead, controller.inversion_tolerances)
        velocity = controller.compute_velocity_commands(control(seen, None, pose, velocity, left))
        pose = pose + 0.05 * np.array([velocity[0], 0.0, velocity[2]])
        farthest = max(farthest, pose[0])
    assert 0.9 <= farthest < 1.1
    assert pose[0] == pytest.approx(-1.0, abs=0.15)


def test_the_curvature_of_a_fixed_point():
    path = line((3.0, 0.5), (0.0, 0.5))
    fixed = regulated(use_fixed_curvature_lookahead=True, curvature_lookahead_dist=1.0)
    velocity = fixed.compute_velocity_commands(control(path, velocity=MOVING))
    assert velocity[2] / velocity[0] == pytest.approx(2.0 * 0.5 / 1.0**2)


def test_the_curvature_beyond_the_goal():
    path = line((0.3, 0.1), (0.0, 0.1))
    near = control(path, velocity=(0.1, 0.0, 0.0), xy_goal_tolerance=0.05)
    beyond = regulated(use_fixed_curvature_lookahead=True, interpolate_curvature_after_goal=True)
    velocity = beyond.compute_velocity_commands(near)
    assert velocity[2] / velocity[0] == pytest.approx(2.0 * 0.1 / 0.6**2, rel=1e-3)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"allow_reversing": True}, "no effect together"),
        ({"interpolate_curvature_after_goal": True}, "needs use_fixed_curvature_lookahead"),
    ],
)
def test_parameters_that_do_not_go_together_are_named(parameters, words):
    lines = []
    context = NavigationContext(name="FollowPath", footprint=ROBOT, warn=lines.append)
    controller = RegulatedPurePursuitController(RegulatedPurePursuitParameters(**parameters), context)
    assert len(lines) == 1
    assert words in lines[0]
    behind = control(line((-3.0, 0.0), heading=0.0))
    assert controller.compute_velocity_commands(behind)[0] >= 0.0
