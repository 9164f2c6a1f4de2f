"""Pose graphs: the poses that agree best with many relative measurements, some of which may be wrong."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2

Array = NDArray[np.float64]

ROBUST_SCALE = 2.0
"""Whitened error beyond which the robust kernel lets a closure count less and less."""

OUTLIER_CHI2 = 25.0
"""Squared whitened error of a closure above which it is taken for false."""


@dataclass(frozen=True)
class Edge:
    """One relative measurement between two poses.

    Attributes
    ----------
    first, second : int
        Indices of the poses.
    measurement : ndarray, shape (3,)
        Pose of the second in the frame of the first.
    information : ndarray, shape (3, 3)
        Inverse covariance in the frame of the second (x, y, yaw).
    closure : bool
        Whether it joins distant parts of the trajectory and may therefore be false.
    """

    first: int
    second: int
    measurement: Array
    information: Array
    closure: bool = False


@dataclass(frozen=True)
class Solution:
    """Poses that agree best with the edges.

    Attributes
    ----------
    poses : ndarray, shape (n, 3)
        The optimised poses; the first is held where it was.
    chi2 : float
        Sum of the squared whitened errors of the edges that were not rejected.
    rejected : tuple of int
        Indices of the closures that disagree with all the others.
    """

    poses: Array
    chi2: float
    rejected: tuple[int, ...]


def optimize(poses: Array, edges: Sequence[Edge], *, chordal: bool = False) -> Solution:
    """Find the poses that agree best with the edges.

    Closures carry a Cauchy kernel; those that still disagree after the first solution are rejected and the
    rest is solved again.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        First guess.
    edges : sequence of Edge
        Measurements; they must connect all the poses.
    chordal : bool
        Start from the chordal relaxation as well (Carlone et al. 2015, "Initialization techniques for 3D
        SLAM") and keep the better solution. Needed where the first guess is so bent that descent sticks in a
        local minimum.
    """
    starts = [np.asarray(poses, dtype=np.float64)]
    if chordal:
        starts.append(_chordal_start(starts[0], edges))
    solutions = [_descend(start, edges) for start in starts]
    best, _ = min(solutions, key=lambda solution: solution[1])
    errors = squared_errors(best, edges)
    rejected = tuple(k for k, edge in enumerate(edges) if edge.closure and errors[k] > OUTLIER_CHI2)
    if rejected:
        outliers = set(rejected)
        kept = [edge for k, edge in enumerate(edges) if k not in outliers]
        best, _ = _descend(best, kept)
        errors = squared_errors(best, kept)
    return Solution(best, float(errors.sum()), rejected)


def squared_errors(poses: Array, edges: Sequence[Edge]) -> Array:
    """Squared whitened error of each edge, shape (m,)."""
    first = np.array([edge.first for edge in edges], dtype=np.int64)
    second = np.array([edge.second for edge in edges], dtype=np.int64)
    measured = np.array([edge.measurement for edge in edges]).reshape(-1, 3)
    information = np.array([edge.information for edge in edges]).reshape(-1, 3, 3)
    error = pose2.between(measured, pose2.between(poses[first], poses[second]))
    squared: Array = np.einsum("ki,kij,kj->k", error, information, error)
    return squared


def _descend(start: Array, edges: Sequence[Edge]) -> tuple[Array, float]:
    """Levenberg-Marquardt from a start: poses and remaining cost."""
    import gtsam

    kernel = gtsam.noiseModel.mEstimator.Cauchy.Create(ROBUST_SCALE)

    def noise_of(edge: Edge) -> Any:
        noise = gtsam.noiseModel.Gaussian.Information(edge.information)
        return gtsam.noiseModel.Robust.Create(kernel, noise) if edge.closure else noise

    graph = _build(edges, start[0], noise_of)
    values = gtsam.Values()
    for index, pose in enumerate(start):
        values.insert(index, gtsam.Pose2(*pose))
    parameters = gtsam.LevenbergMarquardtParams()
    parameters.setRelativeErrorTol(1e-4)
    solved = gtsam.LevenbergMarquardtOptimizer(graph, values, parameters).optimize()
    return _to_array(solved, start.shape[0]), float(graph.error(solved))


def _chordal_start(poses: Array, edges: Sequence[Edge]) -> Array:
    import gtsam

    def noise_of(edge: Edge) -> Any:
        # The relaxation takes one number per measurement: the standard deviation of an average direction.
        return gtsam.noiseModel.Isotropic.Sigma(3, float(np.linalg.det(edge.information)) ** (-1.0 / 6.0))

    return _to_array(gtsam.fastSyncPose2(_build(edges, poses[0], noise_of)), poses.shape[0])


def _build(edges: Sequence[Edge], first: Array, noise_of: Callable[[Edge], Any]) -> Any:
    """Build a graph of factors that holds the first pose where it is."""
    import gtsam

    graph = gtsam.NonlinearFactorGraph()
    for edge in edges:
        measured = gtsam.Pose2(*edge.measurement)
        graph.add(gtsam.BetweenFactorPose2(edge.first, edge.second, measured, noise_of(edge)))
    fixed = gtsam.noiseModel.Isotropic.Sigma(3, 1e-4)
    graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(*first), fixed))
    return graph


def _to_array(values: Any, count: int) -> Array:
    poses = np.empty((count, 3))
    for index in range(count):
        pose = values.atPose2(index)
        poses[index] = pose.x(), pose.y(), pose.theta()
    return poses
