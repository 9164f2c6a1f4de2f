"""Trajectories through waypoints, against scipy's interpolation."""

import numpy as np
import pytest
from scipy import interpolate

from daidalos.control.trajectory import Trajectory, integrated, waypoints
from daidalos.samples.controllers import TrajectoryPoint

TIMES = np.array([0.0, 0.7, 1.0, 2.5])


def random(seed: int, rows: int = 4) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(rows, 3))


def check(trajectory: Trajectory, expected: interpolate.PPoly | interpolate.BPoly, continuous: int) -> None:
    """Compare with scipy's polynomials, up to a derivative, everywhere but at the waypoints' jumps."""
    for time in np.linspace(0.0, 2.49, 60):
        for derivative, found in enumerate(trajectory.sample(time)):
            assert found == pytest.approx(expected(time, nu=derivative), abs=1e-9)
    before, after = trajectory.sample(1.0 - 1e-9), trajectory.sample(1.0)
    for derivative in range(continuous + 1):
        assert before[derivative] == pytest.approx(after[derivative], abs=1e-4)


def test_positions_alone_are_joined_by_lines() -> None:
    positions = random(1)
    slopes = np.diff(positions, axis=0) / np.diff(TIMES)[:, None]
    check(Trajectory(TIMES, positions), interpolate.PPoly(np.stack([slopes, positions[:-1]]), TIMES), continuous=0)


def test_velocities_make_cubic_hermite_splines() -> None:
    positions, velocities = random(1), random(2)
    check(Trajectory(TIMES, positions, velocities), interpolate.CubicHermiteSpline(TIMES, positions, velocities), 1)


def test_accelerations_make_quintic_splines() -> None:
    rows = [random(seed) for seed in (1, 2, 3)]
    expected = interpolate.BPoly.from_derivatives(TIMES, np.stack(rows, axis=1))
    check(Trajectory(TIMES, *rows), expected, continuous=2)


def test_each_segment_is_as_smooth_as_both_its_ends() -> None:
    positions, velocities = random(1), random(2)
    velocities[3] = np.nan
    mixed = Trajectory(TIMES, positions, velocities)
    assert mixed.sample(0.3)[1] == pytest.approx(
        interpolate.CubicHermiteSpline(TIMES[:3], positions[:3], velocities[:3])(0.3, nu=1)
    )
    assert mixed.sample(2.0)[1] == pytest.approx((positions[3] - positions[2]) / 1.5)


def test_it_rests_before_and_after() -> None:
    trajectory = Trajectory(TIMES + 1.0, random(1), random(2))
    for time, row in ((0.5, 0), (3.5, -1), (99.0, -1)):
        position, velocity, acceleration = trajectory.sample(time)
        assert position == pytest.approx(trajectory.positions[row])
        assert not velocity.any()
        assert not acceleration.any()
    keeps = Trajectory(TIMES, random(1), random(2), keep_velocity=True)
    assert keeps.sample(99.0)[1] == pytest.approx(random(2)[-1])


def test_steps_stay_at_each_waypoint() -> None:
    trajectory = Trajectory(TIMES, random(1), random(2), steps=True)
    for time, row in ((0.0, 0), (0.69, 0), (0.7, 1), (2.4, 2), (2.5, 3)):
        assert trajectory.sample(time)[0] == pytest.approx(trajectory.positions[row])
        assert not trajectory.sample(time)[1].any()


def test_shifted_moves_positions_alone() -> None:
    trajectory, offset = Trajectory(TIMES, random(1), random(2)), np.array([1.0, -2.0, 0.0])
    for time in (-1.0, 0.3, 1.7, 5.0):
        plain, moved = trajectory.sample(time), trajectory.shifted(offset).sample(time)
        assert moved[0] == pytest.approx(plain[0] + offset)
        assert moved[1] == pytest.approx(plain[1])


def test_waypoints_are_rows_with_nan_where_nothing_is_said() -> None:
    points = [
        TrajectoryPoint(1.0, positions=np.array([1.0, 2.0])),
        TrajectoryPoint(2.0, positions=np.array([3.0, 4.0]), velocities=np.array([5.0, 6.0])),
    ]
    times, positions, velocities, accelerations = waypoints(points, 2)
    assert times == pytest.approx([1.0, 2.0])
    assert positions == pytest.approx(np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert np.isnan(velocities[0]).all()
    assert velocities[1] == pytest.approx([5.0, 6.0])
    assert np.isnan(accelerations).all()


def test_velocities_integrate_to_positions() -> None:
    times = np.linspace(0.01, 2.0, 200)
    positions = integrated(times, np.sin(times)[:, None], np.array([3.0]))
    assert positions[:, 0] == pytest.approx(4.0 - np.cos(times), abs=1e-3)
