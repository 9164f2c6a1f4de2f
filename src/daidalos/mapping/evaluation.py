"""Evaluation of trajectories and maps against ground truth."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.errors import RelationsError
from daidalos.mapping.grid import OCCUPIED, OccupancyGrid
from daidalos.mapping.text_file import nanoseconds, read_lines
from daidalos.mapping.trajectory import Stamps

MAX_CLOCK_OFFSET, CLOCK_OFFSET_STEP = 0.3, 0.01
"""Largest difference [s] of two clocks that is looked for, and the step of the search."""


@dataclass(frozen=True)
class Relations:
    """True relative poses between pairs of times.

    Attributes
    ----------
    stamps_ns : ndarray of int64, shape (m, 2)
        The two times [ns].
    poses : ndarray, shape (m, 3)
        True pose (x, y, yaw) at the second time in the frame of the robot at the first.
    """

    stamps_ns: Stamps
    poses: Array


@dataclass(frozen=True)
class RelationErrors:
    """Errors of a trajectory against relations.

    Attributes
    ----------
    translation : ndarray, shape (m,)
        Length [m] of the translation of `true^-1 * estimated`.
    rotation : ndarray, shape (m,)
        Absolute value [rad] of its rotation.
    """

    translation: Array
    rotation: Array

    def __str__(self) -> str:
        degrees = np.degrees(self.rotation)
        return (
            f"translation {self.translation.mean():.4f} +- {self.translation.std():.4f} m, "
            f"rotation {degrees.mean():.3f} +- {degrees.std():.3f} deg ({self.translation.size} relations)"
        )

    def summary(self) -> dict[str, float]:
        """Return means and standard deviations in metres and degrees."""
        degrees = np.degrees(self.rotation)
        return {
            "translation_mean_m": float(self.translation.mean()),
            "translation_median_m": float(np.median(self.translation)),
            "translation_std_m": float(self.translation.std()),
            "rotation_mean_deg": float(degrees.mean()),
            "rotation_std_deg": float(degrees.std()),
            "relations": self.translation.size,
        }


@dataclass(frozen=True)
class MapAgreement:
    """Agreement of a map with the true walls, as ratios from 0 to 1.

    Attributes
    ----------
    walls_found : float
        Part of the true wall cells that have an occupied cell of the map nearby.
    walls_true : float
        Part of the occupied cells of the map that have a true wall nearby.
    """

    walls_found: float
    walls_true: float


def read_relations(path: str | Path) -> Relations:
    """Read the true relative poses of a log.

    The file is one of the benchmark of Kuemmerle et al. 2009, "On measuring the accuracy of SLAM algorithms":
    each line holds `t1 t2 x y z roll pitch yaw`, the pose at t2 relative to t1 in seconds, metres and
    radians.

    Raises
    ------
    RelationsError
        Naming the file and the line.
    """
    file = Path(path)
    stamps, poses = [], []
    for number, line in read_lines(file, RelationsError):
        words = line.split()
        try:
            first, second = (nanoseconds(word) for word in words[:2])
            x, y, _, _, _, yaw = (float(word) for word in words[2:])
        except ValueError:
            raise RelationsError(file, number, "expected eight numbers: t1 t2 x y z roll pitch yaw") from None
        if not np.isfinite([x, y, yaw]).all():
            raise RelationsError(file, number, "expected finite numbers")
        stamps.append((first, second))
        poses.append((x, y, yaw))
    if not stamps:
        raise RelationsError(file, None, "no relations in the file")
    return Relations(np.array(stamps, dtype=np.int64), np.array(poses))


def relation_errors(stamps_ns: Stamps, poses: Array, relations: Relations) -> RelationErrors:
    """Compare a trajectory, interpolated at their times, with relations (Kuemmerle et al. 2009).

    Parameters
    ----------
    stamps_ns : ndarray of int64, shape (n,)
        Times of the trajectory [ns], not decreasing.
    poses : ndarray, shape (n, 3)
        The trajectory; before its begin and after its end the robot is taken to stand.
    relations : Relations
        The truth.

    Raises
    ------
    ValueError
        When most relations lie outside of the trajectory's time: they belong to another log.
    """
    inside = (relations.stamps_ns >= stamps_ns[0]) & (relations.stamps_ns <= stamps_ns[-1])
    if np.mean(inside.all(axis=1)) < 0.5:
        first, last = relations.stamps_ns.min() * 1e-9, relations.stamps_ns.max() * 1e-9
        raise ValueError(
            f"the relations belong to another log: they span {first:.3f} to {last:.3f} s, "
            f"the trajectory {stamps_ns[0] * 1e-9:.3f} to {stamps_ns[-1] * 1e-9:.3f} s"
        )
    start = poses_at(stamps_ns, poses, relations.stamps_ns[:, 0])
    end = poses_at(stamps_ns, poses, relations.stamps_ns[:, 1])
    error = pose2.between(relations.poses, pose2.between(start, end))
    return RelationErrors(np.hypot(error[:, 0], error[:, 1]), np.abs(error[:, 2]))


def clock_offset(stamps_ns: Stamps, poses: Array, relations: Relations) -> float:
    """Return the time [s] by which the clock of relations is ahead of a trajectory's, from their rotations.

    Parameters
    ----------
    stamps_ns : ndarray of int64, shape (n,)
        Times of the trajectory [ns], not decreasing.
    poses : ndarray, shape (n, 3)
        The trajectory.
    relations : Relations
        The truth.
    """
    offsets = np.round(np.arange(-MAX_CLOCK_OFFSET, MAX_CLOCK_OFFSET + 1e-9, CLOCK_OFFSET_STEP), 9)
    errors = [relation_errors(stamps_ns, poses, shifted(relations, offset)).rotation.mean() for offset in offsets]
    return float(offsets[int(np.argmin(errors))])


def shifted(relations: Relations, offset: float) -> Relations:
    """Return relations whose clock is set back by an offset [s]."""
    return Relations(relations.stamps_ns - round(offset * 1e9), relations.poses)


def poses_at(stamps_ns: Stamps, poses: Array, times_ns: Stamps) -> Array:
    """Interpolate the poses of a trajectory at other times, linearly between the neighbouring poses."""
    if stamps_ns.size == 1:
        return np.repeat(poses, times_ns.size, axis=0)
    before = np.clip(np.searchsorted(stamps_ns, times_ns, side="right") - 1, 0, stamps_ns.size - 2)
    span = np.maximum(stamps_ns[before + 1] - stamps_ns[before], 1)
    share = np.clip((times_ns - stamps_ns[before]) / span, 0.0, 1.0)
    return pose2.interpolate(poses[before], poses[before + 1], share)


def aligned(estimated: Array, true: Array) -> Array:
    """Move a trajectory (n, 3) rigidly so that its positions lie nearest to those of another (Umeyama 1991)."""
    a, b = estimated[:, :2], true[:, :2]
    centred_a, centred_b = a - a.mean(axis=0), b - b.mean(axis=0)
    along = np.sum(centred_a * centred_b)
    across = np.sum(centred_a[:, 0] * centred_b[:, 1] - centred_a[:, 1] * centred_b[:, 0])
    angle = np.arctan2(across, along)
    turned = pose2.transform_points((0.0, 0.0, angle), a.mean(axis=0)[None, :])[0]
    return pose2.compose(np.array([*(b.mean(axis=0) - turned), angle]), estimated)


def compare_with_truth(
    grid: OccupancyGrid,
    truth: OccupancyGrid,
    *,
    map_pose: tuple[float, float, float] = (0.0, 0.0, 0.0),
    within: float = 2.0,
) -> MapAgreement:
    """Compare the walls of a map with the true ones.

    Parameters
    ----------
    grid : OccupancyGrid
        The map.
    truth : OccupancyGrid
        A raster whose occupied cells are the true walls, as far as a scanner can see them.
    map_pose : tuple of float
        Pose (x, y, yaw) of the map's frame in the frame of the truth.
    within : float
        How far apart, in cells of the map, the middles of two cells may be to be called the same wall.
    """
    from scipy.spatial import cKDTree

    mapped = pose2.transform_points(map_pose, _occupied_middles(grid))
    walls = _occupied_middles(truth)
    if mapped.shape[0] == 0 or walls.shape[0] == 0:
        return MapAgreement(0.0, 0.0)
    reach = within * grid.resolution + 1e-9
    to_map, _ = cKDTree(mapped).query(walls)
    to_wall, _ = cKDTree(walls).query(mapped)
    return MapAgreement(float(np.mean(to_map <= reach)), float(np.mean(to_wall <= reach)))


def _occupied_middles(grid: OccupancyGrid) -> Array:
    """Return the centres of the occupied cells (n, 2) [m] in the frame that the origin is given in."""
    rows, columns = np.nonzero(grid.data == OCCUPIED)
    middles = (np.stack([columns, rows], axis=1).astype(np.float64) + 0.5) * grid.resolution
    return pose2.transform_points(grid.origin, middles)
