"""Gathering of the linear and circular movements of programs into paths."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.welding.seam import MIN_DISTANCE, path_lengths

ARC_STEP = np.radians(3.0)
"""Angle between two points on a circle [rad]."""


class PathRuns:
    """Paths of a program: each begins after a movement by the joints."""

    def __init__(self) -> None:
        self._runs: list[list[NDArray[np.float64]]] = [[]]

    @property
    def last(self) -> NDArray[np.float64] | None:
        """Return the latest pose (4, 4) of the present path, None at its beginning."""
        return self._runs[-1][-1] if self._runs[-1] else None

    def begin(self, start: NDArray[np.float64] | None) -> None:
        """Start a new path, at a pose where it is known."""
        self._runs.append([] if start is None else [start])

    def add(self, poses: Iterable[NDArray[np.float64]]) -> None:
        """Add poses (4, 4) to the present path; one at the place of the latest is left out."""
        for pose in poses:
            if self.last is None or np.linalg.norm(pose[:3, 3] - self.last[:3, 3]) > MIN_DISTANCE:
                self._runs[-1].append(pose)

    def longest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the positions (n, 3) [m] and orientations (n, 3, 3) of the longest path."""
        stacks = [np.array(run).reshape(-1, 4, 4) for run in self._runs]
        longest = max(stacks, key=lambda stack: path_lengths(stack[:, :3, 3])[-1] if len(stack) else -1.0)
        return longest[:, :3, 3], longest[:, :3, :3]


def arc(start: NDArray[np.float64], via: NDArray[np.float64], end: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Return poses along the circle from a pose through another to a third; the orientation turns evenly."""
    from scipy.spatial.transform import Rotation, Slerp

    positions = arc_points(start[:3, 3], via[:3, 3], end[:3, 3])
    ends = Rotation.from_matrix(np.stack([start[:3, :3], end[:3, :3]]))
    poses = np.tile(np.eye(4), (len(positions), 1, 1))
    poses[:, :3, :3] = Slerp([0.0, 1.0], ends)(np.linspace(0.0, 1.0, len(positions) + 1)[1:]).as_matrix()
    poses[:, :3, 3] = positions
    return list(poses)


def arc_points(start: NDArray[np.float64], via: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, 3) of the circle from one through another to a third, without the first."""
    one, two = via - start, end - start
    normal = np.cross(one, two)
    squared = float(normal @ normal)
    if squared <= 1e-12 * float(one @ one) * float(two @ two):
        return np.stack([via, end])
    centre = start + (np.cross(normal, one) * (two @ two) + np.cross(two, normal) * (one @ one)) / (2.0 * squared)
    x = start - centre
    y = np.cross(normal / np.sqrt(squared), x)
    angle = float(np.arctan2((end - centre) @ y, (end - centre) @ x)) % (2.0 * np.pi)
    steps = np.linspace(0.0, angle, max(int(np.ceil(angle / ARC_STEP)), 2) + 1)[1:, None]
    points: NDArray[np.float64] = centre + np.cos(steps) * x + np.sin(steps) * y
    return points
