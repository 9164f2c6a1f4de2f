"""Point-to-line refinement of a match (iterative closest line).

After Censi 2008, "An ICP variant using a point-to-line metric".
"""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.mapping.scan_matching.buckets import Indices, Reference

POINT_DEVIATION = 0.1
"""Standard deviation [m] of one point in a match: beams are better, but neighbours err alike."""

NOISE = 0.03
"""Distance [m] from its line beyond which a point counts less and less."""

MIN_MATCHES = 6
"""Points that must have found a line for a step to be taken."""

SAME_FACE = 0.7
"""Least cosine of the angle between the normals of a point and its line: a wall's far side is no match."""

NORMAL_NOISE = 0.1
"""Standard deviation [rad] of a normal: by it, a straight wall seems to tell something about the way along it."""

DAMPING = 1e-5
"""Share of the points' weight that holds back what no line constrains, as the way along a corridor."""

SETTLED_SHIFT = 2e-4
SETTLED_TURN = 1e-4
"""Step [m], [rad] after which nothing more is expected."""


@dataclass(frozen=True)
class Refinement:
    """Result of a point-to-line match.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose of the scan in the frame of the reference.
    normal_matrix : ndarray, shape (3, 3)
        Matrix of the normal equations in the frame of the scan (x, y, yaw): the information, were the
        standard deviation of a point 1 m.
    residual : float
        Root of the weighted mean squared distance [m] of the matched points from their lines.
    inlier_ratio : float
        Part of the points that have normals that found a line.
    """

    pose: Array
    normal_matrix: Array
    residual: float
    inlier_ratio: float


def refine(
    points: Array,
    normals: Array,
    reference: Reference,
    guess: Array,
    *,
    reach: float = 0.2,
    iterations: int = 30,
) -> Refinement:
    """Match a scan to the lines of a reference by Gauss-Newton steps with Geman-McClure weights.

    Parameters
    ----------
    points, normals : ndarray, shape (n, 2)
        The scan; points without a normal are left out.
    reference : Reference
        What it is matched against.
    guess : ndarray, shape (3,)
        Pose to start from.
    reach : float
        Largest distance [m] across a line at which it is taken, at the start; it shrinks with the steps.
    iterations : int
        Most steps taken.
    """
    pose, normal_matrix, residual, inlier_ratio = _refine(
        points,
        normals,
        reference.points,
        reference.normals,
        reference.starts,
        reference.columns,
        reference.corner,
        reference.cell,
        np.array(guess, dtype=np.float64),
        float(reach),
        int(iterations),
    )
    return Refinement(pose, normal_matrix, residual, inlier_ratio)


def match_information(normal_matrix: Array) -> Array:
    """Return the inverse covariance (3, 3) of a match; an unconstrained direction has a deviation of 10 m.

    What noisy normals alone would seem to tell is taken off every direction.
    """
    weight = max(float(normal_matrix[0, 0] + normal_matrix[1, 1]), 1e-9)
    # Yaw is measured at the typical distance of the points, so that all directions are in metres.
    metres = np.array([1.0, 1.0, np.sqrt(weight / max(float(normal_matrix[2, 2]), 1e-9))])
    values, vectors = np.linalg.eigh(normal_matrix * metres[:, None] * metres)
    told = np.maximum(values - weight * NORMAL_NOISE**2, 0.0)
    cleaned = (vectors * told) @ vectors.T / metres[:, None] / metres
    information: Array = cleaned / POINT_DEVIATION**2 + 0.01 * np.eye(3)
    return information


@compiled
def _refine(
    points: Array,
    normals: Array,
    lines: Array,
    line_normals: Array,
    starts: Indices,
    columns: int,
    corner: Array,
    cell: float,
    guess: Array,
    reach: float,
    iterations: int,
) -> tuple[Array, Array, float, float]:
    x, y, yaw = guess[0], guess[1], guess[2]
    limit = reach
    matrix = np.zeros((3, 3))
    vector = np.zeros(3)
    residual = 0.0
    inlier_ratio = 0.0
    for _ in range(iterations):
        cosine, sine = np.cos(yaw), np.sin(yaw)
        scale = max(NOISE, 0.5 * limit)
        matrix[:] = 0.0
        vector[:] = 0.0
        squares = 0.0
        weights = 0.0
        matched = 0
        usable = 0
        for i in range(points.shape[0]):
            if normals[i, 0] == 0.0 and normals[i, 1] == 0.0:
                continue
            usable += 1
            px, py = points[i, 0], points[i, 1]
            wx = x + cosine * px - sine * py
            wy = y + sine * px + cosine * py
            wnx = cosine * normals[i, 0] - sine * normals[i, 1]
            wny = sine * normals[i, 0] + cosine * normals[i, 1]
            j = _nearest(wx, wy, wnx, wny, lines, line_normals, starts, columns, corner, cell, limit)
            if j < 0:
                continue
            matched += 1
            nx, ny = line_normals[j, 0], line_normals[j, 1]
            error = nx * (wx - lines[j, 0]) + ny * (wy - lines[j, 1])
            weight = (scale * scale / (scale * scale + error * error)) ** 2
            squares += weight * error * error
            weights += weight
            # The step is taken in the frame of the scan, so the normal is turned into it.
            ax = cosine * nx + sine * ny
            ay = cosine * ny - sine * nx
            at = px * ay - py * ax
            _add_row(matrix, vector, ax, ay, at, weight, error)
        inlier_ratio = matched / usable if usable > 0 else 0.0
        if matched < MIN_MATCHES:
            break
        residual = np.sqrt(squares / weights)
        dx, dy, turn = _solve(matrix, vector, DAMPING * weights)
        x += cosine * dx - sine * dy
        y += sine * dx + cosine * dy
        yaw += turn
        if limit <= 4.0 * NOISE and abs(dx) + abs(dy) < SETTLED_SHIFT and abs(turn) < SETTLED_TURN:
            break
        limit = max(min(4.0 * NOISE, reach), 0.7 * limit)
    pose = np.array([x, y, (yaw + np.pi) % (2.0 * np.pi) - np.pi])
    return pose, matrix, residual, inlier_ratio


@compiled
def _nearest(
    x: float,
    y: float,
    nx: float,
    ny: float,
    lines: Array,
    line_normals: Array,
    starts: Indices,
    columns: int,
    corner: Array,
    cell: float,
    limit: float,
) -> int:
    """Find the nearest line that faces the same way within the limit across it; -1 where there is none."""
    rows = (starts.shape[0] - 1) // columns
    column = int(np.floor((x - corner[0]) / cell))
    row = int(np.floor((y - corner[1]) / cell))
    left = max(column - 1, 0)
    right = min(column + 2, columns)
    best = -1
    best_square = cell * cell
    if left >= right:
        return best
    for r in range(max(row - 1, 0), min(row + 2, rows)):
        for j in range(starts[r * columns + left], starts[r * columns + right]):
            if nx * line_normals[j, 0] + ny * line_normals[j, 1] < SAME_FACE:
                continue
            dx, dy = x - lines[j, 0], y - lines[j, 1]
            if abs(line_normals[j, 0] * dx + line_normals[j, 1] * dy) > limit:
                continue
            square = dx * dx + dy * dy
            if square < best_square:
                best_square = square
                best = j
    return best


@compiled
def _add_row(matrix: Array, vector: Array, ax: float, ay: float, at: float, weight: float, error: float) -> None:
    """Add one row of the Jacobian to the normal equations."""
    matrix[0, 0] += weight * ax * ax
    matrix[0, 1] += weight * ax * ay
    matrix[0, 2] += weight * ax * at
    matrix[1, 1] += weight * ay * ay
    matrix[1, 2] += weight * ay * at
    matrix[2, 2] += weight * at * at
    matrix[1, 0] = matrix[0, 1]
    matrix[2, 0] = matrix[0, 2]
    matrix[2, 1] = matrix[1, 2]
    vector[0] += weight * ax * error
    vector[1] += weight * ay * error
    vector[2] += weight * at * error


@compiled
def _solve(matrix: Array, vector: Array, damping: float) -> tuple[float, float, float]:
    """Solve (matrix + damping) step = -vector by Cramer's rule."""
    a, b, c = matrix[0, 0] + damping, matrix[0, 1], matrix[0, 2]
    d, e, f = matrix[1, 1] + damping, matrix[1, 2], matrix[2, 2] + damping
    u, v, w = -vector[0], -vector[1], -vector[2]
    m0, m1, m2 = d * f - e * e, c * e - b * f, b * e - c * d
    determinant = a * m0 + b * m1 + c * m2
    x = (u * m0 + v * m1 + w * m2) / determinant
    y = (u * m1 + v * (a * f - c * c) + w * (b * c - a * e)) / determinant
    z = (u * m2 + v * (b * c - a * e) + w * (a * d - b * b)) / determinant
    return x, y, z
