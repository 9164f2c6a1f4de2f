"""Vector pursuit: its screws from geometry, what limits them, and that it follows paths."""

import math

import numpy as np
import pytest

from daidalos.common.pose2 import move_along_arc, wrap
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.controllers.vector_pursuit_controller import (
    VectorPursuitController,
    VectorPursuitParameters,
)
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NoValidControl
from daidalos.navigation.paths import with_headings

from .scenes import control, ground, line

ROBOT = Footprint.circle(0.2)
MOVING = (0.5, 0.0, 0.0)


def vector_pursuit(**parameters):
    given = {"use_velocity_scaled_lookahead_dist": False, "min_turning_radius": 0.1, "max_lateral_accel": 10.0}
    return VectorPursuitController(VectorPursuitParameters(**given | parameters), NavigationContext(footprint=ROBOT))


def curvature(path, velocity=MOVING, **parameters):
    commanded = vector_pursuit(**parameters).compute_velocity_commands(control(path, velocity=velocity))
    return commanded[2] / commanded[0]


def test_straight_ahead_at_full_speed():
    velocity = vector_pursuit().compute_velocity_commands(control(line((3.0, 0.0)), velocity=MOVING))
    assert velocity == pytest.approx([0.5, 0.0, 0.0])


@pytest.mark.parametrize("radius", [0.8, -0.8, 2.0])
@pytest.mark.parametrize("k", [2.0, 8.0])
def test_an_arc_is_followed_whatever_k_is(radius, k):
    angles = np.linspace(0.0, 1.2, 200) * 0.8 / abs(radius)
    points = np.stack([abs(radius) * np.sin(angles), radius * (1.0 - np.cos(angles))], axis=-1)
    assert curvature(with_headings(points), k=k) == pytest.approx(1.0 / radius, rel=0.02)


def test_the_direction_of_the_path_counts_the_more_the_smaller_k_is():
    path = line((3.0, 0.3), (0.0, 0.3))  # along x, beside the robot
    x, y = math.sqrt(0.6**2 - 0.3**2), 0.3
    phi = 2.0 * math.atan2(y, x)
    pure = 2.0 * y / 0.6**2
    for k in (2.0, 8.0, 1e6):
        expected = pure * ((k - 1.0) * phi + 0.0) / (k * phi)
        assert curvature(path, k=k) == pytest.approx(expected, rel=1e-6)


def test_headings_of_the_path_count_where_it_is_wanted():
    path = line((3.0, 0.3), (0.0, 0.3))
    path[:, 2] = 0.5
    assert curvature(path, use_heading_from_path=True) > curvature(path) + 0.05


def test_the_point_is_between_two_poses_or_the_next_one():
    path = with_headings(np.array([[0.0, 0.2], [0.5, 0.2], [1.5, 0.5]]))
    assert curvature(path) != pytest.approx(curvature(path, use_interpolation=False))


def test_curves_are_no_tighter_than_the_turning_radius():
    path = line((0.0, 3.0))
    assert abs(curvature(path, use_rotate_to_heading=False, min_turning_radius=0.7)) == pytest.approx(1.0 / 0.7)


def test_curves_are_slow_by_their_lateral_acceleration():
    path = line((3.0, 0.3), (0.0, 0.3))
    velocity = vector_pursuit(max_lateral_accel=0.1).compute_velocity_commands(control(path, velocity=(0.3, 0.0, 0.0)))
    assert velocity[0] ** 2 * abs(velocity[2] / velocity[0]) == pytest.approx(0.1)
    least = vector_pursuit(max_lateral_accel=0.001, min_linear_velocity=0.2)
    assert least.compute_velocity_commands(control(path, velocity=(0.2, 0.0, 0.0)))[0] == pytest.approx(0.2)


def test_obstacles_within_the_horizon_are_refused():
    ahead = control(line((3.0, 0.0)), ground([(0.75, 0.0)]), velocity=MOVING)
    with pytest.raises(NoValidControl):
        vector_pursuit(lookahead_dist=1.0, max_allowed_time_to_collision_up_to_target=2.0).compute_velocity_commands(
            ahead
        )
    near = vector_pursuit(lookahead_dist=1.0, max_allowed_time_to_collision_up_to_target=0.2)
    assert near.compute_velocity_commands(ahead)[0] > 0.0


@pytest.mark.parametrize("reverses", [False, True])
def test_a_curved_path_is_followed_to_its_end(reverses):
    x = np.linspace(0.0, 2.5, 200)
    path = with_headings(np.stack([-x if reverses else x, 0.4 * (1.0 - np.cos(2.0 * x))], axis=-1))
    parameters = {"use_rotate_to_heading": False, "allow_reversing": True, "min_turning_radius": 0.2}
    controller = vector_pursuit(**parameters, lookahead_dist=0.3)
    pose, velocity, worst = np.zeros(3), np.zeros(3), 0.0
    for _ in range(400):
        nearest = int(np.argmin(np.hypot(*(path - pose)[:, :2].T)))
        worst = max(worst, float(np.hypot(*(path[nearest] - pose)[:2])))
        velocity = controller.compute_velocity_commands(control(path[nearest:], None, pose, velocity))
        pose = move_along_arc(pose, velocity[0] * 0.05, velocity[2] * 0.05)
        if math.hypot(*(path[-1] - pose)[:2]) < 0.1:
            break
    assert math.hypot(*(path[-1] - pose)[:2]) < 0.1
    assert worst < 0.06
    travels = float(pose[2]) + (math.pi if reverses else 0.0)
    assert abs(float(wrap(travels - path[-1, 2]))) < 0.3


def test_the_speed_limit_acts():
    controller = vector_pursuit()
    controller.set_speed_limit(0.2, percentage=False)
    assert controller.compute_velocity_commands(control(line((3.0, 0.0)), velocity=(0.2, 0.0, 0.0)))[0] == 0.2
