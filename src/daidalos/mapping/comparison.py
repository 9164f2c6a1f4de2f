"""Comparison of a trajectory with another one: absolute and relative errors, and the offset of the clocks."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.evaluation import (
    RelationErrors,
    Relations,
    aligned,
    clock_offset,
    poses_at,
    relation_errors,
    shifted,
)
from daidalos.mapping.trajectory import Stamps, Trajectory, travelled

MAX_PAIRS = 2000
"""Pairs of poses that relative errors are computed of at most, spread evenly."""


@dataclass(frozen=True)
class TrajectoryErrors:
    """Errors of a trajectory against a reference.

    Attributes
    ----------
    distances : ndarray, shape (n,)
        From the reference [m] after rigid alignment, at the times of the reference.
    turns : ndarray, shape (n,)
        Absolute differences of heading [rad].
    relative : RelationErrors
        Of the motions over the same distance.
    delta : float
        That distance [m].
    offset : float
        Time [s] by which the reference's clock is ahead; 0 where there are no times.
    """

    distances: Array
    turns: Array
    relative: RelationErrors
    delta: float
    offset: float

    def summary(self) -> dict[str, Any]:
        """Return the errors in metres and degrees."""
        degrees = np.degrees(self.turns)
        return {
            "poses": self.distances.size,
            "ate_rmse_m": float(np.sqrt(np.mean(self.distances**2))),
            "ate_mean_m": float(self.distances.mean()),
            "ate_median_m": float(np.median(self.distances)),
            "ate_max_m": float(self.distances.max()),
            "heading_mean_deg": float(degrees.mean()),
            "heading_max_deg": float(degrees.max()),
            "rpe_delta_m": self.delta,
            "rpe": self.relative.summary(),
            "clock_offset_s": self.offset,
        }


def compare_trajectories(estimated: Trajectory, reference: Trajectory, delta: float = 1.0) -> TrajectoryErrors:
    """Compare a trajectory with a reference.

    Where both have times, the estimated one is interpolated at those of the reference, whose clock is set back by the
    offset that makes the relative rotations agree best (`clock_offset`). Else they need the same number of poses.

    Parameters
    ----------
    estimated, reference : Trajectory
    delta : float
        Distance [m] over which relative errors are computed.

    Raises
    ------
    ValueError
        When they cannot be compared; the text says why.
    """
    if estimated.stamps_ns is None or reference.stamps_ns is None:
        stamps = _counted(estimated, reference)
        return _errors(estimated.poses, stamps, reference.poses, stamps, delta, 0.0)
    own, given = estimated.stamps_ns, reference.stamps_ns
    relations = _relations_along(given, reference.poses, delta)
    offset = 0.0 if _never_together(own, given) else clock_offset(own, estimated.poses, relations)
    moved = given - round(offset * 1e9)
    common = (moved >= own[0]) & (moved <= own[-1])
    if common.sum() < 2:
        raise ValueError(
            f"the trajectories are of different times: {own[0] * 1e-9:.3f} to {own[-1] * 1e-9:.3f} s, "
            f"the reference {given[0] * 1e-9:.3f} to {given[-1] * 1e-9:.3f} s"
        )
    return _errors(estimated.poses, own, reference.poses[common], moved[common], delta, offset)


def compare_with_relations(estimated: Trajectory, relations: Relations) -> tuple[RelationErrors, float]:
    """Return the errors of a trajectory against relations, and the offset [s] of their clock, which is taken out.

    Raises
    ------
    ValueError
        When the trajectory has no times, or the relations belong to another log.
    """
    if estimated.stamps_ns is None:
        raise ValueError("relations need a trajectory with times")
    relation_errors(estimated.stamps_ns, estimated.poses, relations)  # which checks that both are of one log
    offset = clock_offset(estimated.stamps_ns, estimated.poses, relations)
    return relation_errors(estimated.stamps_ns, estimated.poses, shifted(relations, offset)), offset


def _errors(
    estimated: Array, own: Stamps, reference: Array, stamps: Stamps, delta: float, offset: float
) -> TrajectoryErrors:
    """Return the errors at the times of a reference, whose clock is the estimated trajectory's."""
    found = aligned(poses_at(own, estimated, stamps), reference)
    rest = pose2.between(reference, found)
    relative = relation_errors(own, estimated, _relations_along(stamps, reference, delta))
    return TrajectoryErrors(np.hypot(rest[:, 0], rest[:, 1]), np.abs(rest[:, 2]), relative, delta, offset)


def _counted(estimated: Trajectory, reference: Trajectory) -> Stamps:
    """Return times for poses that are compared one by one."""
    counts = len(estimated.poses), len(reference.poses)
    if counts[0] != counts[1] or counts[0] < 2:
        raise ValueError(f"without times both must have the same number of poses, at least 2; found {counts}")
    return np.arange(counts[0], dtype=np.int64) * 10**9


def _never_together(own: Stamps, given: Stamps) -> bool:
    inside = (given >= own[0]) & (given <= own[-1])
    return bool(np.mean(inside) < 0.5)


def _relations_along(stamps_ns: Stamps, poses: Array, delta: float) -> Relations:
    """Return the motions of a trajectory over a distance [m], from as many poses as `MAX_PAIRS`.

    Raises
    ------
    ValueError
        When the whole way is shorter.
    """
    way = travelled(poses)
    starts = np.flatnonzero(way <= way[-1] - delta)
    if not starts.size:
        raise ValueError(f"the reference is {way[-1]:.2f} m long: relative errors over {delta:g} m need a longer one")
    starts = starts[np.linspace(0, starts.size - 1, min(starts.size, MAX_PAIRS)).astype(int)]
    ends = np.searchsorted(way, way[starts] + delta - 1e-9)
    return Relations(np.stack([stamps_ns[starts], stamps_ns[ends]], axis=1), pose2.between(poses[starts], poses[ends]))
