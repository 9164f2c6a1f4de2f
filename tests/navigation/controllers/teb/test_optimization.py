"""Least squares of the band: slopes against differences, and trajectories against closed forms."""

import numpy as np
import pytest

from daidalos.navigation.controllers.teb import optimization as places
from daidalos.navigation.controllers.teb.optimization import WIDTH, linearize, optimize

POINT = np.zeros((1, 3))
NOWHERE = np.full((2, 2), 1e3, dtype=np.float32)
NO_POINTS = np.zeros((0, 2)), np.zeros(0)
SPEED, ACCELERATION = 0.5, 0.4


def limits(**changes):
    values = np.array([SPEED, 0.2, 0.0, 1.0, ACCELERATION, 0.5, 1.0, 0.0, 0.0, 0.3, 0.5, 1.0, 0.0, 0.0, 0.0])
    for name, value in changes.items():
        values[getattr(places, name)] = value
    return values


def weights(**changes):
    values = np.array([2.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1000.0, 1.0, 1.0, 1.0, 0.0, 50.0, 0.1, 1.0, 50.0])
    for name, value in changes.items():
        values[getattr(places, name)] = value
    return values


@pytest.mark.parametrize("seed", range(4))
def test_slopes_are_those_of_the_cost(seed):
    random = np.random.default_rng(seed)
    n = 6
    poses = np.cumsum(random.uniform(-0.3, 0.5, (n, 3)), axis=0)
    times = random.uniform(0.1, 0.4, n - 1)
    field = np.fromfunction(lambda row, column: 0.05 * np.hypot(row - 40, column - 40), (80, 80)).astype(np.float32)
    bounds = limits(
        MAX_FORWARD=0.1, MAX_BACKWARD=0.05, MAX_TURN=0.1, MAX_ACCELERATION=0.1, TURNING_RADIUS=0.6, MARGIN=0.02,
        OBSTACLE_DISTANCE=1.0, INFLATION_DISTANCE=1.5, OBSTACLE_EXPONENT=1.3, TURN_DIRECTION=1.0,
        MAX_SIDEWAYS=0.05 * (seed % 2),
    )  # fmt: skip
    given = weights(NONHOLONOMIC=3.0, LENGTH=0.7)
    outline = np.array([[0.1, 0.05, 0.1], [-0.2, 0.0, 0.1]])
    points, nearest = random.uniform(-1, 1, (2, 2)), np.array([2.0, 3.0])

    def cost(unknowns, slope):
        rows = unknowns.reshape(n, 4)
        return linearize(
            np.ascontiguousarray(rows[:, :3]), np.ascontiguousarray(rows[:-1, 3]), np.array([0.1, 0.0, 0.05]), bounds,
            given, outline, field, np.array([-2.0, -2.0]), 0.05, points, nearest, np.zeros((4 * n, WIDTH)), slope,
        )  # fmt: skip

    at = np.concatenate([poses, np.append(times, 1.0)[:, None]], axis=1).ravel()
    slope, unused = np.zeros(4 * n), np.zeros(4 * n)
    cost(at, slope)
    differences = [(cost(at + step, unused) - cost(at - step, unused)) / 4e-6 for step in 1e-6 * np.eye(4 * n)]
    free = slice(3, 4 * n - 4)
    assert slope[free] == pytest.approx(np.array(differences)[free], rel=1e-5, abs=1e-4)


def optimized(poses, bounds, given, field=NOWHERE, origin=(0.0, 0.0), resolution=1.0, iterations=200, points=NO_POINTS):
    poses, times = poses.copy(), np.full(len(poses) - 1, 0.3)
    optimize(
        poses, times, np.zeros(3), bounds, given, POINT, field, np.array(origin), resolution, *points, iterations
    )  # fmt: skip
    return poses, times


def straight(length, count=31):
    return np.stack([np.linspace(0.0, length, count), np.zeros(count), np.zeros(count)], axis=-1)


def test_the_fastest_way_straight_ahead_is_a_trapezium_of_speed():
    stiff = weights(FORWARD=1e4, ACCELERATION=1e4)
    length = 4.0
    _, times = optimized(straight(length, 121), limits(), stiff)
    least = length / SPEED + SPEED / ACCELERATION
    assert times.sum() == pytest.approx(least, rel=0.03)
    poses, times = optimized(straight(length, 121), limits(FREE_GOAL_SPEED=1.0), stiff)
    assert times.sum() == pytest.approx(least - 0.5 * SPEED / ACCELERATION, rel=0.03)
    assert np.abs(poses[:, 1:]).max() < 1e-9


def test_a_turn_on_the_spot_takes_as_long_as_its_rate_allows():
    poses = np.zeros((11, 3))
    poses[:, 2] = np.linspace(0.0, 2.0, 11)
    poses, times = optimized(poses, limits(MAX_TURN_ACCELERATION=1e3), weights(TURN=1e4))
    assert times.sum() == pytest.approx(2.0, rel=0.03)
    assert np.abs(poses[:, :2]).max() < 1e-6


def test_steps_are_arcs_of_the_turning_radius():
    poses = straight(0.0, 25)
    poses[:, 0], poses[:, 1] = np.linspace(0.0, 1.0, 25), np.linspace(0.0, 1.0, 25)
    poses[1:-1, 2], poses[-1, 2] = np.pi / 4, np.pi / 2
    bounds = limits(TURNING_RADIUS=1.0, MAX_TURN=5.0, MAX_TURN_ACCELERATION=50.0)
    poses, _ = optimized(poses, bounds, weights(RADIUS=1e3), iterations=500)
    # From (0, 0) to the right to (1, 1) upwards there is one such arc.
    assert np.hypot(poses[:, 0], poses[:, 1] - 1.0) == pytest.approx(np.ones(25), abs=0.02)


def test_obstacles_are_passed_at_their_distance():
    rows, columns = np.mgrid[0:80, 0:80]
    field = (0.05 * np.hypot(rows - 39, columns - 39)).astype(np.float32)  # one at (2, 2)
    poses = straight(4.0)
    poses[:, 1] = 2.05
    poses, _ = optimized(poses, limits(), weights(OBSTACLE=1e4), field, resolution=0.05)
    nearest = np.hypot(*(poses[:, :2] - 1.975).T).min()
    assert nearest == pytest.approx(0.3, abs=0.03)
    assert poses[:, 1].max() < 2.6


def test_points_attract_the_band():
    points = np.array([[2.0, 0.5]]), np.array([15.0])
    poses, _ = optimized(straight(4.0), limits(), weights(VIA_POINT=1e3), points=points)
    assert poses[15, :2] == pytest.approx([2.0, 0.5], abs=0.05)
    assert poses[[0, -1]] == pytest.approx(straight(4.0)[[0, -1]], abs=1e-9)
