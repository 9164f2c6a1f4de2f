"""Trajectories in KITTI's format: lines with the upper three rows of a pose's matrix, without times."""

from pathlib import Path

import numpy as np

from daidalos.common.arrays import Array
from daidalos.mapping.errors import GraphFileError
from daidalos.mapping.text_file import read_lines, write_lines
from daidalos.mapping.trajectory import Trajectory

NUMBERS = 12
"""Numbers in a line, row by row."""


def read_kitti(path: Path) -> Trajectory:
    """Read a trajectory whose z axis points up; the position and the heading in the plane are kept.

    Raises
    ------
    GraphFileError
        Naming the file and the line.
    """
    poses: list[Array] = []
    for number, line in read_lines(path, GraphFileError):
        try:
            values = np.array([float(word) for word in line.replace(",", " ").split()])
        except ValueError:
            values = np.zeros(0)
        if len(values) != NUMBERS or not np.isfinite(values).all():
            raise GraphFileError(path, number, "expected twelve finite numbers: the upper rows of a pose's matrix")
        matrix = values.reshape(3, 4)
        poses.append(np.array([matrix[0, 3], matrix[1, 3], np.arctan2(matrix[1, 0], matrix[0, 0])]))
    if not poses:
        raise GraphFileError(path, None, "no poses in the file")
    return Trajectory(None, np.array(poses))


def write_kitti(path: Path, trajectory: Trajectory) -> None:
    """Write a trajectory, whose times are lost.

    Raises
    ------
    GraphFileError
        When the file cannot be written.
    """
    lines = (
        f"{np.cos(yaw):.9f} {-np.sin(yaw):.9f} 0 {x:.6f} {np.sin(yaw):.9f} {np.cos(yaw):.9f} 0 {y:.6f} 0 0 1 0\n"
        for x, y, yaw in trajectory.poses.tolist()
    )
    write_lines(path, lines, GraphFileError)
