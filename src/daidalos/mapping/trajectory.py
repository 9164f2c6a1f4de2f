"""Trajectories in the plane, and the files that hold them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.errors import GraphFileError

Stamps = NDArray[np.int64]

CARMEN_SUFFIXES = (".log", ".clf", ".carmen")
BAG_SUFFIXES = (".mcap", ".db3")


@dataclass(frozen=True)
class Trajectory:
    """Poses of a robot in the order of their times.

    Attributes
    ----------
    stamps_ns : ndarray of int64, shape (n,), or None
        Times [ns], not decreasing; None where the file has none.
    poses : ndarray, shape (n, 3)
        Poses (x, y, yaw) [m, rad].
    """

    stamps_ns: Stamps | None
    poses: Array


def sorted_trajectory(stamps_ns: list[int], poses: list[Array]) -> Trajectory:
    """Return a trajectory of stamped poses in any order."""
    times = np.array(stamps_ns, dtype=np.int64)
    order = np.argsort(times, kind="stable")
    return Trajectory(times[order], np.array(poses)[order])


def read_trajectory(path: str | Path) -> Trajectory:
    """Read a trajectory: TUM, KITTI, CARMEN's log, g2o, or the odometry of a bag.

    Lines of 8 numbers are TUM's (time, position, quaternion), lines of 12 are KITTI's (upper rows of a matrix).
    ``.g2o`` holds a pose graph; ``.log``, ``.clf`` and ``.carmen`` are CARMEN's, of which the scans' poses are read.

    Raises
    ------
    MappingError
        When it is none of them.
    """
    from daidalos.mapping import carmen_log, g2o_file, kitti_file, tum_file
    from daidalos.mapping.text_file import read_lines

    file = Path(path)
    suffix = format_suffix(file)
    if file.is_dir() or suffix in BAG_SUFFIXES:
        from daidalos.mapping.log import read_log

        log = read_log(file)
        return Trajectory(log.odometry_stamps_ns, log.all_odometry)
    if suffix == ".g2o":
        return Trajectory(None, g2o_file.read_g2o(file)[0])
    if suffix in CARMEN_SUFFIXES:
        return carmen_log.read_carmen(file).trajectory
    lines = read_lines(file, GraphFileError)
    if not lines:
        raise GraphFileError(file, None, "no poses in the file")
    numbers = len(lines[0][1].replace(",", " ").split())
    if numbers == kitti_file.NUMBERS:
        return kitti_file.read_kitti(file)
    if numbers == tum_file.NUMBERS:
        return tum_file.read_tum(file)
    raise GraphFileError(file, lines[0][0], f"expected 8 numbers (TUM) or 12 (KITTI), found {numbers} words")


def write_trajectory(path: str | Path, trajectory: Trajectory) -> None:
    """Write a trajectory: KITTI's format for ``.kitti``, else TUM's.

    Raises
    ------
    GraphFileError
        When the file cannot be written, or TUM's format is asked for without times.
    """
    from daidalos.mapping import kitti_file, tum_file

    file = Path(path)
    (kitti_file.write_kitti if file.suffix.lower() == ".kitti" else tum_file.write_tum)(file, trajectory)


def format_suffix(path: Path) -> str:
    """Return the suffix that names a file's format, without the ``.gz`` of a compressed one."""
    return Path(path.stem if path.suffix.lower() == ".gz" else path.name).suffix.lower()


def travelled(poses: Array) -> Array:
    """Return the length of the way [m] up to each pose (n,)."""
    steps = pose2.between(poses[:-1], poses[1:])
    return np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))])
