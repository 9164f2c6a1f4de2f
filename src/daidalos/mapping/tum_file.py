"""Trajectories in TUM's format: lines of time, position and quaternion."""

from pathlib import Path

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import yaw_from_quaternion
from daidalos.mapping.errors import GraphFileError
from daidalos.mapping.text_file import nanoseconds, read_lines, seconds_text, write_lines
from daidalos.mapping.trajectory import Trajectory, sorted_trajectory

NUMBERS = 8
"""Numbers in a line: t x y z qx qy qz qw."""


def read_tum(path: Path) -> Trajectory:
    """Read a trajectory; of poses in space the position and the heading in the plane are kept.

    Raises
    ------
    GraphFileError
        Naming the file and the line.
    """
    stamps: list[int] = []
    poses: list[Array] = []
    for number, line in read_lines(path, GraphFileError):
        words = line.replace(",", " ").split()
        try:
            stamp = nanoseconds(words[0])
            x, y, _, qx, qy, qz, qw = (float(word) for word in words[1:])
        except ValueError:
            raise GraphFileError(path, number, "expected eight numbers: t x y z qx qy qz qw") from None
        if not np.isfinite([x, y, qx, qy, qz, qw]).all() or not any((qx, qy, qz, qw)):
            raise GraphFileError(path, number, "expected finite numbers and a quaternion that is not zero")
        stamps.append(stamp)
        poses.append(np.array([x, y, yaw_from_quaternion((qx, qy, qz, qw))]))
    if not stamps:
        raise GraphFileError(path, None, "no poses in the file")
    return sorted_trajectory(stamps, poses)


def write_tum(path: Path, trajectory: Trajectory) -> None:
    """Write a trajectory.

    Raises
    ------
    GraphFileError
        When it has no times, or the file cannot be written.
    """
    if trajectory.stamps_ns is None:
        raise GraphFileError(path, None, "TUM's format needs times, which the poses do not have")
    lines = (
        f"{seconds_text(stamp)} {x:.6f} {y:.6f} 0 0 0 {np.sin(yaw / 2):.9f} {np.cos(yaw / 2):.9f}\n"
        for stamp, (x, y, yaw) in zip(trajectory.stamps_ns.tolist(), trajectory.poses.tolist(), strict=True)
    )
    write_lines(path, lines, GraphFileError)
