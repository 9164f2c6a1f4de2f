"""Pose graphs: least-squares poses from relative measurements with outliers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array

ROBUST_SCALE = 2.0
"""Whitened error beyond which the robust kernel lets a closure count less and less."""

OUTLIER_CHI2 = 25.0
"""Squared whitened error of a closure above which it is taken for false."""

MAX_STEPS = 100
"""Steps after which descent ends although the cost may still fall."""

RELATIVE_TOLERANCE = 1e-5
"""Part of the cost that a step must save for descent to go on."""

EXPLAINED = 1.5
"""Chi2 per degree of freedom up to which a solution is taken for the best one without another start."""

MIN_DAMPING, START_DAMPING, MAX_DAMPING = 1e-12, 1e-5, 1e10
"""Range of the damping that is added to the diagonal of the normal equations, and its first value."""


@dataclass(frozen=True)
class Edge:
    """Relative measurement between two poses.

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
    """Poses that fit the edges best.

    Attributes
    ----------
    poses : ndarray, shape (n, 3)
        The optimized poses; the first is held where it was.
    chi2 : float
        Sum of the squared whitened errors of the edges that were not rejected.
    rejected : tuple of int
        Indices of the closures that disagree with all the others.
    """

    poses: Array
    chi2: float
    rejected: tuple[int, ...]


class _Edges(NamedTuple):
    """Edges as arrays: one row for each of m edges."""

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    measured: Array
    information: Array
    closure: NDArray[np.bool_]

    def only(self, kept: NDArray[np.bool_]) -> "_Edges":
        """Return the edges that a mask selects."""
        return _Edges(
            self.first[kept], self.second[kept], self.measured[kept], self.information[kept], self.closure[kept]
        )


def optimize(poses: Array, edges: Sequence[Edge], *, chordal: bool = False) -> Solution:
    """Find the poses that fit the edges best.

    Closures carry a Cauchy kernel; those that still disagree after the first solution are rejected and the
    rest is solved again.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        First guess.
    edges : sequence of Edge
        Measurements; they must connect all the poses.
    chordal : bool
        Start from the chordal relaxation (Carlone et al. 2015, "Initialization techniques for 3D SLAM"), and
        where that leaves more than the noise of the edges explains, from the first guess as well; the better
        solution is kept. Needed where the first guess is so bent that descent sticks in a local minimum.
    """
    rows = _columns(edges)
    guess = np.asarray(poses, dtype=np.float64)
    best, cost = _descend(_chordal_start(guess, rows) if chordal else guess, rows)
    if chordal and 2.0 * cost > EXPLAINED * 3.0 * (len(edges) - len(guess) + 1):
        best, _ = min((best, cost), _descend(guess, rows), key=lambda solution: solution[1])
    outliers = rows.closure & (_squared_errors(best, rows) > OUTLIER_CHI2)
    if outliers.any():
        rows = rows.only(~outliers)
        best, _ = _descend(best, rows)
    chi2 = float(_squared_errors(best, rows).sum())
    return Solution(best, chi2, tuple(int(k) for k in np.flatnonzero(outliers)))


def squared_errors(poses: Array, edges: Sequence[Edge]) -> Array:
    """Compute the squared whitened error of each edge, shape (m,)."""
    return _squared_errors(poses, _columns(edges))


def without_pose(edges: Sequence[Edge], index: int) -> list[Edge]:
    """Return a graph without one pose: its edges lead on from the neighbour that it is tied to best.

    Parameters
    ----------
    edges : sequence of Edge
        The graph.
    index : int
        The pose; those after it are numbered one lower in the result.
    """
    touching = [edge for edge in edges if index in (edge.first, edge.second)]
    kept = [edge for edge in edges if index not in (edge.first, edge.second)]
    if touching:
        best = max(touching, key=lambda edge: (not edge.closure, float(np.linalg.det(edge.information))))
        to_pose = best if best.second == index else _reversed(best)
        for edge in touching:
            away = edge if edge.first == index else _reversed(edge)
            if edge is not best and away.second != to_pose.first:
                kept.append(_forward(_chained(to_pose, away)))
    return [
        replace(edge, first=edge.first - (edge.first > index), second=edge.second - (edge.second > index))
        for edge in kept
    ]


def _forward(edge: Edge) -> Edge:
    return edge if edge.first < edge.second else _reversed(edge)


def _reversed(edge: Edge) -> Edge:
    """Return an edge from its second pose to its first one."""
    turn = _adjoint(edge.measurement)
    information: Array = np.linalg.inv(turn @ np.linalg.inv(edge.information) @ turn.T).astype(np.float64)
    return Edge(edge.second, edge.first, pose2.inverse(edge.measurement), information, edge.closure)


def _chained(first: Edge, second: Edge) -> Edge:
    """Return the edge from the first pose of one edge over a common pose to the last pose of another."""
    turn = _adjoint(pose2.inverse(second.measurement))
    covariance = turn @ np.linalg.inv(first.information) @ turn.T + np.linalg.inv(second.information)
    information: Array = np.linalg.inv(covariance).astype(np.float64)
    measured = pose2.compose(first.measurement, second.measurement)
    return Edge(first.first, second.second, measured, information, first.closure or second.closure)


def _adjoint(pose: Array) -> Array:
    """Return the matrix that carries small motions (x, y, yaw) in a frame at a pose to the frame it is given in."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    return np.array([[cosine, -sine, pose[1]], [sine, cosine, -pose[0]], [0.0, 0.0, 1.0]])


def _columns(edges: Sequence[Edge]) -> _Edges:
    return _Edges(
        np.array([edge.first for edge in edges], dtype=np.intp),
        np.array([edge.second for edge in edges], dtype=np.intp),
        np.array([edge.measurement for edge in edges], dtype=np.float64).reshape(-1, 3),
        np.array([edge.information for edge in edges], dtype=np.float64).reshape(-1, 3, 3),
        np.array([edge.closure for edge in edges], dtype=np.bool_),
    )


def _errors(poses: Array, edges: _Edges) -> Array:
    """Compute the pose of each second pose as measured, relative to that as estimated; shape (m, 3)."""
    return pose2.between(edges.measured, pose2.between(poses[edges.first], poses[edges.second]))


def _squared_errors(poses: Array, edges: _Edges) -> Array:
    error = _errors(poses, edges)
    squared: Array = np.einsum("ki,kij,kj->k", error, edges.information, error)
    return squared


def _cost(poses: Array, edges: _Edges) -> float:
    """Compute half the sum of squared whitened errors, those of closures under the Cauchy kernel."""
    squared, scale = _squared_errors(poses, edges), ROBUST_SCALE**2
    return float(0.5 * np.where(edges.closure, scale * np.log1p(squared / scale), squared).sum())


def _descend(start: Array, edges: _Edges) -> tuple[Array, float]:
    """Run Levenberg-Marquardt from a start: poses and remaining cost; the first pose is held."""
    poses, cost, damping = start.copy(), _cost(start, edges), START_DAMPING
    for _ in range(MAX_STEPS):
        hessian, gradient = _normal_equations(poses, edges)
        while True:
            moved = _moved(poses, -_solved(hessian, gradient, damping).reshape(-1, 3))
            lower = _cost(moved, edges)
            if lower <= cost:
                break
            damping *= 10.0
            if damping > MAX_DAMPING:
                return poses, cost
        saved = cost - lower
        poses, cost, damping = moved, lower, max(damping / 10.0, MIN_DAMPING)
        if saved <= RELATIVE_TOLERANCE * cost:
            break
    return poses, cost


def _moved(poses: Array, step: Array) -> Array:
    """Move all poses but the first along arcs of constant twist, so that rigid parts stay rigid as they turn."""
    moved = poses.copy()
    half = step[:, 2] / 2.0
    moved[1:, :2] += np.sinc(half / np.pi)[:, None] * _rotated(step[:, :2], half)
    moved[1:, 2] = pose2.wrap(moved[1:, 2] + step[:, 2])
    return moved


def _rotated(vectors: Array, angle: Array) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)


def _normal_equations(poses: Array, edges: _Edges) -> tuple[Any, Array]:
    """Linearise: the Hessian's approximation of all poses but the first, and the gradient of the cost."""
    from scipy.sparse import coo_array

    error = _errors(poses, edges)
    by_first, by_second = _jacobians(poses, edges)
    squared = np.einsum("ki,kij,kj->k", error, edges.information, error)
    weight = np.where(edges.closure, 1.0 / (1.0 + squared / ROBUST_SCALE**2), 1.0)
    information = weight[:, None, None] * edges.information
    jacobians, ends = (by_first, by_second), (edges.first, edges.second)
    size = 3 * len(poses)
    gradient = np.zeros(size)
    blocks, rows, columns = [], [], []
    component = np.arange(3)
    for left, row in zip(jacobians, ends, strict=True):
        weighted = left.transpose(0, 2, 1) @ information
        at = 3 * row[:, None] + component
        np.add.at(gradient, at, np.einsum("kij,kj->ki", weighted, error))
        for right, column in zip(jacobians, ends, strict=True):
            blocks.append((weighted @ right).ravel())
            rows.append(np.repeat(at, 3, axis=1).ravel())
            columns.append(np.tile(3 * column[:, None] + component, (1, 3)).ravel())
    places = np.concatenate(rows), np.concatenate(columns)
    hessian = coo_array((np.concatenate(blocks), places), shape=(size, size)).tocsc()
    return hessian[3:, 3:], gradient[3:]


def _jacobians(poses: Array, edges: _Edges) -> tuple[Array, Array]:
    """Compute the derivatives of the errors by the first and by the second poses, each of shape (m, 3, 3)."""
    offset = (poses[edges.second] - poses[edges.first])[:, :2]
    turned = poses[edges.first, 2] + edges.measured[:, 2]
    cos, sin = np.cos(turned), np.sin(turned)
    by_second = np.zeros((len(turned), 3, 3))
    by_second[:, 0, 0], by_second[:, 0, 1] = cos, sin
    by_second[:, 1, 0], by_second[:, 1, 1] = -sin, cos
    by_second[:, 2, 2] = 1.0
    by_first = -by_second
    by_first[:, 0, 2] = cos * offset[:, 1] - sin * offset[:, 0]
    by_first[:, 1, 2] = -cos * offset[:, 0] - sin * offset[:, 1]
    return by_first, by_second


def _solved(matrix: Any, right: NDArray[Any], damping: float = 0.0) -> NDArray[Any]:
    """Solve a sparse system that is symmetric and positive definite once damped."""
    from scipy.sparse import eye_array
    from scipy.sparse.linalg import splu

    damped = (matrix + damping * eye_array(matrix.shape[0])).tocsc()
    factors = splu(damped, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    solution: NDArray[Any] = factors.solve(right)
    return solution


def _chordal_start(poses: Array, edges: _Edges) -> Array:
    """Solve for the headings as unit complex numbers without the constraint, then for the positions; both are linear.

    The relaxation takes one number per measurement: the information of an average direction.
    """
    weight = np.cbrt(np.linalg.det(edges.information))
    turn = np.exp(1j * edges.measured[:, 2])
    heading = _relaxed(len(poses), edges, weight, turn, np.zeros(len(weight)), np.exp(1j * poses[0, 2]))
    heading /= np.abs(heading)
    step = heading[edges.first] * (edges.measured[:, 0] + 1j * edges.measured[:, 1])
    position = _relaxed(len(poses), edges, weight, np.ones_like(turn), step, complex(*poses[0, :2]))
    return np.stack([position.real, position.imag, np.angle(heading)], axis=1)


def _relaxed(
    count: int, edges: _Edges, weight: Array, factor: NDArray[Any], shift: NDArray[Any], fixed: complex
) -> NDArray[np.complex128]:
    """Return the complex z, z_0 given, with the least sum of ``weight abs(z_second - factor z_first - shift)**2``."""
    from scipy.sparse import coo_array

    entry, row = np.arange(len(weight)), np.sqrt(weight)
    values = np.concatenate([row, -row * factor])
    places = np.tile(entry, 2), np.concatenate([edges.second, edges.first])
    matrix = coo_array((values, places), shape=(len(weight), count)).tocsc()
    right = row * shift - matrix[:, [0]].toarray()[:, 0] * fixed
    free = matrix[:, 1:]
    adjoint = free.conj().T
    return np.concatenate([[fixed], _solved(adjoint @ free, adjoint @ right)])
