"""Occupancy grid of log odds: update by scans, and matching of scans by Gauss-Newton on its interpolated values."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import transform_points
from daidalos.mapping.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, beam_bounds, count_beams

LogOdds = NDArray[np.float32]

MARGIN = 2
"""Cells around those that the beams of a scan touch, for rounding."""

MAX_LOG_ODDS = 50.0
"""Magnitude up to which the log odds of a cell grow."""

MAX_TURN = 0.2
"""Largest turn [rad] of one iteration."""

MAX_STEP = 2.0
"""Largest motion of one iteration, in cells: a gradient holds for no longer way."""

DAMPING = 1e-3
"""Share of the largest diagonal element that is added to the normal equations where a corridor leaves them singular."""

CONVERGED = 1e-5
"""Step [m, rad] below which iterations end."""


@dataclass(frozen=True)
class GridMatch:
    """Result of matching a scan against a grid.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) of the base in the map.
    information : ndarray, shape (3, 3)
        Inverse covariance of the pose, in the frame of the map.
    overlap : float
        Share of the points that lie where the grid is known.
    misfit : float
        Mean square of 1 - M over the points.
    """

    pose: Array
    information: Array
    overlap: float
    misfit: float


class LogOddsGrid:
    """Square grid whose cells hold the log odds of an obstacle.

    Parameters
    ----------
    size : int
        Cells along each side.
    resolution : float
        Side of a cell [m].
    corner : tuple of float
        Position (x, y) [m] of the lower left corner in the map's frame.
    """

    def __init__(self, size: int, resolution: float, corner: tuple[float, float]) -> None:
        self.resolution = resolution
        self._corner = np.array(corner, dtype=np.float64)
        self._log_odds: LogOdds = np.zeros((size, size), np.float32)

    def clear(self) -> None:
        """Forget everything."""
        self._log_odds[:] = 0.0

    def update(self, ends: Array, origin: Array, pose: Array, free: float, occupied: float) -> None:
        """Change the cells that the beams of a scan reached; each cell once.

        Beams that leave the grid are not used.

        Parameters
        ----------
        ends : ndarray, shape (n, 2)
            Where beams ended, in the frame of the base [m].
        origin : ndarray, shape (2,)
            Where they began.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the base.
        free, occupied : float
            Log odds added to cells that beams passed through, and to those in which they ended.
        """
        shifted = np.array([pose[0] - self._corner[0], pose[1] - self._corner[1], pose[2]])
        side = self._log_odds.shape[0] * self.resolution
        placed = transform_points(shifted, np.vstack([origin, ends]))
        inside = ((placed >= 0.0) & (placed < side)).all(axis=1)
        used = np.ascontiguousarray(ends[inside[1:]])
        if not inside[0] or not len(used):
            return
        nothing = np.zeros((0, 2))
        bounds = beam_bounds(used, nothing, origin, shifted, self.resolution)
        corner = bounds[:2] - MARGIN
        columns, rows = (bounds[2:] + 1 + MARGIN - corner).tolist()
        hits, misses = np.zeros((rows, columns), np.int32), np.zeros((rows, columns), np.int32)
        count_beams(used, origin, shifted, self.resolution, corner, hits, misses, 1, True)
        _change(self._log_odds, hits, misses, corner, free, occupied)

    def match(self, points: Array, pose: Array, iterations: int) -> GridMatch:
        """Match points (n, 2) of the base's frame from a pose (x, y, yaw) on.

        The sum of squares of 1 - M is minimized by Gauss-Newton, with the probability M of an obstacle interpolated
        bilinearly at each point (Kohlbrecher et al. 2011: "A Flexible and Scalable SLAM System with Full 3D Motion
        Estimation").
        """
        found, normal, rest, known = _minimize(
            self._log_odds, points, self._corner, self.resolution, np.array(pose, dtype=np.float64), iterations
        )
        variance = max(rest / max(len(points) - 3, 1), 1e-6)
        count = max(len(points), 1)
        return GridMatch(found, normal / variance, known / count, rest / count)

    def classify(self) -> OccupancyGrid:
        """Return the cells as occupied, free or unknown."""
        data = np.full(self._log_odds.shape, UNKNOWN, np.int8)
        data[self._log_odds < 0.0] = FREE
        data[self._log_odds > 0.0] = OCCUPIED
        return OccupancyGrid(data, self.resolution, (float(self._corner[0]), float(self._corner[1]), 0.0))


@compiled
def _change(
    log_odds: LogOdds,
    hits: NDArray[np.int32],
    misses: NDArray[np.int32],
    corner: NDArray[np.int64],
    free: float,
    occupied: float,
) -> None:
    """Add to each cell once: where a beam ended, that it is occupied; else that it is free where one passed."""
    for i in range(hits.shape[0]):
        for j in range(hits.shape[1]):
            if hits[i, j] == 0 and misses[i, j] == 0:
                continue
            row, column = i + corner[1], j + corner[0]
            if 0 <= row < log_odds.shape[0] and 0 <= column < log_odds.shape[1]:
                value = log_odds[row, column] + (occupied if hits[i, j] > 0 else free)
                log_odds[row, column] = min(max(value, -MAX_LOG_ODDS), MAX_LOG_ODDS)


@compiled
def _probability(log_odds: float) -> float:
    return 1.0 / (1.0 + math.exp(-log_odds))


@compiled
def _solve(matrix: Array, right: Array) -> Array:
    """Solve three symmetric, positive definite equations by Cholesky decomposition."""
    lower = np.zeros((3, 3))
    solution = right.copy()
    for i in range(3):
        for j in range(i + 1):
            rest = matrix[i, j]
            for k in range(j):
                rest -= lower[i, k] * lower[j, k]
            lower[i, j] = np.sqrt(rest) if i == j else rest / lower[j, j]
        for k in range(i):
            solution[i] -= lower[i, k] * solution[k]
        solution[i] /= lower[i, i]
    for i in (2, 1, 0):
        for k in range(i + 1, 3):
            solution[i] -= lower[k, i] * solution[k]
        solution[i] /= lower[i, i]
    return solution


@compiled
def _minimize(
    log_odds: LogOdds, points: Array, corner: Array, resolution: float, pose: Array, iterations: int
) -> tuple[Array, Array, float, int]:
    """Return the pose, the normal equations' matrix there, the sum of squares and the number of points on the map."""
    pose = pose.copy()
    for _ in range(iterations):
        matrix, right, _, known = _normal_equations(log_odds, points, corner, resolution, pose)
        largest = max(matrix[0, 0], matrix[1, 1])
        if known == 0 or largest <= 0.0:
            break
        # A turn moves points by its angle times their distance, so its element is of another size.
        matrix[0, 0] += DAMPING * largest
        matrix[1, 1] += DAMPING * largest
        matrix[2, 2] += DAMPING * max(matrix[2, 2], largest)
        step = _solve(matrix, right)
        way = np.hypot(step[0], step[1])
        if way > MAX_STEP * resolution:
            step[:2] *= MAX_STEP * resolution / way
        step[2] = min(max(step[2], -MAX_TURN), MAX_TURN)
        pose += step
        if way < CONVERGED and abs(step[2]) < CONVERGED:
            break
    pose[2] = (pose[2] + np.pi) % (2.0 * np.pi) - np.pi
    matrix, _, rest, known = _normal_equations(log_odds, points, corner, resolution, pose)
    return pose, matrix, rest, known


@compiled
def _normal_equations(
    log_odds: LogOdds, points: Array, corner: Array, resolution: float, pose: Array
) -> tuple[Array, Array, float, int]:
    matrix = np.zeros((3, 3))
    right = np.zeros(3)
    gradient = np.zeros(3)
    rest = 0.0
    known = 0
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    rows, columns = log_odds.shape
    for i in range(points.shape[0]):
        x = cosine * points[i, 0] - sine * points[i, 1]
        y = sine * points[i, 0] + cosine * points[i, 1]
        # Values lie in the centres of cells.
        u = (pose[0] + x - corner[0]) / resolution - 0.5
        v = (pose[1] + y - corner[1]) / resolution - 0.5
        if not (0.0 <= u < columns - 1 and 0.0 <= v < rows - 1):
            rest += 1.0
            continue
        c, r = int(u), int(v)
        a, b = u - c, v - r
        low_left, low_right = log_odds[r, c], log_odds[r, c + 1]
        high_left, high_right = log_odds[r + 1, c], log_odds[r + 1, c + 1]
        if low_left == 0.0 and low_right == 0.0 and high_left == 0.0 and high_right == 0.0:
            rest += 0.25
            continue
        known += 1
        p00, p01 = _probability(low_left), _probability(low_right)
        p10, p11 = _probability(high_left), _probability(high_right)
        missing = 1.0 - ((1.0 - b) * ((1.0 - a) * p00 + a * p01) + b * ((1.0 - a) * p10 + a * p11))
        gradient[0] = ((1.0 - b) * (p01 - p00) + b * (p11 - p10)) / resolution
        gradient[1] = ((1.0 - a) * (p10 - p00) + a * (p11 - p01)) / resolution
        gradient[2] = x * gradient[1] - y * gradient[0]
        for j in range(3):
            right[j] += gradient[j] * missing
            for k in range(3):
                matrix[j, k] += gradient[j] * gradient[k]
        rest += missing * missing
    return matrix, right, rest, known
