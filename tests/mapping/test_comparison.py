"""Comparison of trajectories: errors, and the offset of the clocks."""

from __future__ import annotations

import numpy as np
import pytest

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.comparison import compare_trajectories, compare_with_relations
from daidalos.mapping.evaluation import Relations
from daidalos.mapping.trajectory import Trajectory, travelled


def way(times: Array) -> Array:
    """Return poses on a figure of eight."""
    x, y = 4.0 * np.sin(0.3 * times), 2.0 * np.sin(0.6 * times)
    return np.column_stack([x, y, np.arctan2(1.2 * np.cos(0.6 * times), 1.2 * np.cos(0.3 * times))])


TIMES = np.arange(0.0, 25.0, 0.1)
TRUE = Trajectory((TIMES * 1e9).astype(np.int64), way(TIMES))
MOVED = (3.0, -2.0, 1.0)


def test_neither_the_frame_nor_the_clock_counts() -> None:
    times = np.arange(1.0, 24.0, 0.07)
    same = Trajectory(((times - 0.12) * 1e9).astype(np.int64), pose2.compose(MOVED, way(times)))
    found = compare_trajectories(same, TRUE)
    assert found.offset == pytest.approx(0.12)
    assert found.distances.max() < 2e-3
    assert found.turns.max() < 5e-3
    assert found.relative.translation.mean() < 1e-3


def test_errors_are_those_of_the_definition() -> None:
    rng = np.random.default_rng(3)
    noisy = TRUE.poses + np.column_stack([0.05 * rng.standard_normal((len(TIMES), 2)), np.zeros(len(TIMES))])
    found = compare_trajectories(Trajectory(TRUE.stamps_ns, pose2.compose(MOVED, noisy)), TRUE, 2.0)
    assert found.summary()["ate_rmse_m"] == pytest.approx(0.05 * np.sqrt(2.0), rel=0.1)
    scaled = Trajectory(TRUE.stamps_ns, TRUE.poses * (1.02, 1.02, 1.0))
    relative = compare_trajectories(scaled, TRUE, 2.0).relative
    straight = np.hypot(*pose2.between(TRUE.poses[:-20], TRUE.poses[20:])[:, :2].T)
    assert 0.0 < relative.translation.max() < 0.02 * 1.2 * straight.max()
    assert relative.rotation.max() < 1e-9


def test_without_times_poses_are_compared_one_by_one() -> None:
    unstamped = Trajectory(None, pose2.compose(MOVED, TRUE.poses))
    found = compare_trajectories(unstamped, TRUE)
    assert (found.offset, found.distances.size) == (0.0, len(TIMES))
    assert found.distances.max() < 1e-9
    with pytest.raises(ValueError, match="must have the same number of poses"):
        compare_trajectories(Trajectory(None, TRUE.poses[1:]), TRUE)


def test_what_cannot_be_compared_is_said() -> None:
    assert TRUE.stamps_ns is not None
    later = Trajectory(TRUE.stamps_ns + 10**12, TRUE.poses)
    with pytest.raises(ValueError, match="the trajectories are of different times"):
        compare_trajectories(later, TRUE)
    length = travelled(TRUE.poses)[-1]
    with pytest.raises(ValueError, match=f"the reference is {length:.2f} m long"):
        compare_trajectories(TRUE, TRUE, 1000.0)
    with pytest.raises(ValueError, match="relations need a trajectory with times"):
        compare_with_relations(Trajectory(None, TRUE.poses), Relations(np.zeros((1, 2), np.int64), np.zeros((1, 3))))


def test_relations_have_a_clock_of_their_own() -> None:
    assert TRUE.stamps_ns is not None
    pairs = np.stack([TRUE.stamps_ns[20:-40:9], TRUE.stamps_ns[40:-20:9]], axis=1)
    poses = pose2.between(TRUE.poses[20:-40:9], TRUE.poses[40:-20:9])
    errors, offset = compare_with_relations(TRUE, Relations(pairs + 80_000_000, poses))
    assert offset == pytest.approx(0.08)
    assert errors.translation.max() < 1e-9
