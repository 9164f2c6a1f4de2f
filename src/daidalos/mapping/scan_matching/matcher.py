"""Matcher of a scan against the points of others: correlation first, point-to-line refinement second."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.mapping.scan import Cloud
from daidalos.mapping.scan_matching.branch_and_bound import Match, search
from daidalos.mapping.scan_matching.buckets import Reference, build_reference
from daidalos.mapping.scan_matching.likelihood import Likelihood, build_likelihood
from daidalos.mapping.scan_matching.point_to_line import Refinement, refine

REACH = 0.2
"""Largest distance [m] over which a point looks for its line."""

SEARCH_POINTS = 120
"""Points of a scan that a correlation looks at; more cost time and change nothing."""


@dataclass(frozen=True)
class Window:
    """Range and resolution of a correlation search.

    Attributes
    ----------
    distance, angle : float
        Half width [m] and [rad].
    resolution : float
        Step [m].
    deviation : float
        Standard deviation [m] by which the points of the map are smeared.
    distance_penalty, angle_penalty : float
        What the score loses [1/m^2], [1/rad^2] with the square of the way from the middle.
    minimum_score : float
        Poses that score less are not looked at.
    """

    distance: float
    angle: float
    resolution: float = 0.05
    deviation: float = 0.05
    distance_penalty: float = 0.0
    angle_penalty: float = 0.0
    minimum_score: float = 0.0

    @property
    def depth(self) -> int:
        """Number of halvings of the search blocks, such that few initial blocks cover the window."""
        return max(0, int(np.log2(max(1.0, 0.5 * self.distance / self.resolution))))


class PointMap:
    """Points of several scans in one frame, prepared for matching on first use.

    Parameters
    ----------
    clouds : sequence of Cloud
        The scans.
    poses : ndarray, shape (n, 3)
        Their poses in the frame of the map.
    """

    def __init__(self, clouds: Sequence[Cloud], poses: Array) -> None:
        self.points, self.normals = merge(clouds, poses)
        self._likelihoods: dict[tuple[float, float, int], Likelihood] = {}

    @cached_property
    def reference(self) -> Reference:
        """Points sorted for nearest-neighbour search."""
        return build_reference(self.points, self.normals, REACH)

    def likelihood(self, window: Window) -> Likelihood:
        """Return the likelihood grid for a correlation over a window."""
        key = (window.resolution, window.deviation, window.depth)
        if key not in self._likelihoods:
            self._likelihoods[key] = build_likelihood(self.points, *key)
        return self._likelihoods[key]

    def correlate(self, points: Array, guess: Array, window: Window) -> Match | None:
        """Find the best pose of points (n, 2) in a window; None where none reaches the minimum score."""
        if self.points.shape[0] == 0:
            return None
        stride = max(1, points.shape[0] // SEARCH_POINTS)
        return search(
            np.ascontiguousarray(points[::stride]),
            self.likelihood(window),
            guess,
            distance=window.distance,
            angle=window.angle,
            minimum_score=window.minimum_score,
            distance_penalty=window.distance_penalty,
            angle_penalty=window.angle_penalty,
        )

    def refine(self, points: Array, normals: Array, guess: Array, *, iterations: int = 30) -> Refinement:
        """Refine the pose of points with normals (n, 2) against the lines of the map, from a good guess."""
        return refine(points, normals, self.reference, guess, reach=REACH, iterations=iterations)


def merge(clouds: Sequence[Cloud], poses: Array) -> tuple[Array, Array]:
    """Return points and normals (n, 2) of several scans in the frame that their poses (m, 3) are given in."""
    total = sum(cloud.points.shape[0] for cloud in clouds)
    points, normals = np.empty((total, 2)), np.empty((total, 2))
    start = 0
    for cloud, pose in zip(clouds, poses, strict=True):
        _place(cloud.points, cloud.normals, pose, points, normals, start)
        start += cloud.points.shape[0]
    return points, normals


@compiled
def _place(points: Array, normals: Array, pose: Array, placed: Array, turned: Array, start: int) -> None:
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for i in range(points.shape[0]):
        placed[start + i, 0] = pose[0] + cosine * points[i, 0] - sine * points[i, 1]
        placed[start + i, 1] = pose[1] + sine * points[i, 0] + cosine * points[i, 1]
        turned[start + i, 0] = cosine * normals[i, 0] - sine * normals[i, 1]
        turned[start + i, 1] = sine * normals[i, 0] + cosine * normals[i, 1]
