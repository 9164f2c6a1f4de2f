"""Optimisation of a path's points: sparse least squares over smoothness, curvature, nearness and cost.

Levenberg-Marquardt; each residual depends on a point and its two neighbours, so that the normal equations are banded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.costmap.costmap import Costmap

_STEP = 1e-6
_BAND = 5
_MOST_DAMPING = 1e16


@dataclass(frozen=True)
class Weights:
    """Weights of the squared residuals of inner points.

    Attributes
    ----------
    smooth, distance, curvature : float
        Of second differences, of distances [m] from the given points, of curvature [1/m] above the largest.
    cost : ndarray, shape (n,)
        Of the costs (0 to 255) under each of the points.
    largest_curvature : float
        Reciprocal of the turning radius [1/m]; infinite where the robot turns in place.
    check_points : ndarray, shape (k, 3)
        Places (x [m], y [m]) in the robot's frame under which costs are taken, and the share of each.
    """

    smooth: float
    distance: float
    curvature: float
    cost: Array
    largest_curvature: float
    check_points: Array


@dataclass(frozen=True)
class Limits:
    """Ends of the optimisation.

    Attributes
    ----------
    max_iterations : int
    param_tol : float
        Share of the coordinates' norm that a step is smaller by.
    fn_tol : float
        Share of the sum of squares that a step changes less.
    gradient_tol : float
        Largest slope of the sum of squares.
    is_dense : bool
        Whether steps are computed from the whole Jacobian instead of the banded normal equations.
    """

    max_iterations: int
    param_tol: float
    fn_tol: float
    gradient_tol: float
    is_dense: bool


@dataclass(frozen=True)
class Outcome:
    """Optimised points (n, 2), the number of iterations, and half of the sum of squares before and after."""

    points: Array
    iterations: int
    before: float
    after: float


def optimize(
    points: Array, signs: Array, fixed: NDArray[np.bool_], costmap: Costmap, weights: Weights, limits: Limits
) -> Outcome:
    """Move points so that the weighted sum of squares gets small.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        No two neighbours are at one place.
    signs : ndarray, shape (n - 1,)
        Of each step between points: 1 where it is driven forward, -1 backward.
    fixed : ndarray of bool, shape (n,)
        Points that stay; both ends do.
    costmap : Costmap
    weights : Weights
    limits : Limits
    """
    problem = _Problem(points, signs, costmap, weights)
    movable = np.repeat(~fixed, 2)
    x = points.copy()
    residuals = problem.residuals(x[:-2], x[1:-1], x[2:])
    total = before = 0.5 * float((residuals**2).sum())
    damping, done = 1e-4, 0
    while done < limits.max_iterations and movable.any():
        done += 1
        jacobian = problem.jacobian(x)
        slope = _slope(jacobian, residuals, movable)
        if np.abs(slope).max() <= limits.gradient_tol:
            break
        is_improved = False
        while not is_improved and damping < _MOST_DAMPING:
            step = (_dense_step if limits.is_dense else _banded_step)(jacobian, residuals, slope, movable, damping)
            there = x + step.reshape(-1, 2)
            residuals_there = problem.residuals(there[:-2], there[1:-1], there[2:])
            total_there = 0.5 * float((residuals_there**2).sum())
            is_improved = total_there < total
            damping = max(0.1 * damping, 1e-12) if is_improved else 10.0 * damping
        if not is_improved:
            break
        change, moved = total - total_there, float(np.linalg.norm(step))
        x, residuals, total = there, residuals_there, total_there
        is_still = moved <= limits.param_tol * (float(np.linalg.norm(x)) + limits.param_tol)
        if change <= limits.fn_tol * total or is_still:
            break
    return Outcome(x, done, before, total)


class _Problem:
    """Residuals (n - 2, 6) of the inner points."""

    def __init__(self, points: Array, signs: Array, costmap: Costmap, weights: Weights) -> None:
        lengths = np.hypot(*np.diff(points, axis=0).T)
        self._given = points[1:-1]
        self._turned = np.where(signs[1:] == signs[:-1], 1.0, -1.0)[:, None]
        self._ratio = self._turned * (lengths[:-1] / lengths[1:])[:, None]
        self._sign = signs[:-1, None]
        self._weights, self._roots = weights, np.sqrt(weights.cost[1:-1])
        self._costmap = costmap
        self._costs = costmap.costs.astype(np.float64)

    def residuals(self, before: Array, here: Array, after: Array) -> Array:
        """Return the residuals of points (n - 2, 2) with their neighbours."""
        w = self._weights
        ahead, behind = after - here, here - before
        found = np.empty((here.shape[0], 6))
        found[:, :2] = w.smooth**0.5 * (self._ratio * ahead - behind)
        curvature = curvatures(behind, self._turned * ahead)
        found[:, 2] = w.curvature**0.5 * np.maximum(curvature - w.largest_curvature, 0.0)
        found[:, 3:5] = w.distance**0.5 * (here - self._given)
        found[:, 5] = 0.0
        if self._roots.any():
            direction = self._sign * tangents(behind, self._turned * ahead)
            for x, y, share in w.check_points:
                across = np.stack([-direction[:, 1], direction[:, 0]], axis=-1)
                found[:, 5] += share * self._cost_at(here + x * direction + y * across)
            found[:, 5] *= self._roots
        return found

    def _cost_at(self, places: Array) -> Array:
        cells = (places - self._costmap.origin) / self._costmap.resolution - 0.5
        return interpolated(self._costs, cells)

    def jacobian(self, x: Array) -> Array:
        """Return the derivatives (n - 2, 6, 6) of the residuals by the coordinates of the points before, at, after."""
        found = np.empty((x.shape[0] - 2, 6, 6))
        parts = [x[:-2], x[1:-1], x[2:]]
        for k in range(6):
            shift = np.zeros(2)
            shift[k % 2] = _STEP
            sides = []
            for sign in (1.0, -1.0):
                moved = [part + sign * shift if i == k // 2 else part for i, part in enumerate(parts)]
                sides.append(self.residuals(*moved))
            found[:, :, k] = (sides[0] - sides[1]) / (2.0 * _STEP)
        return found


def curvatures(behind: Array, ahead: Array) -> Array:
    """Return the curvature (n,) of the circles through points, by the steps (n, 2) to them and from them."""
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    product = np.hypot(*behind.T) * np.hypot(*ahead.T) * np.hypot(*(behind + ahead).T)
    return np.asarray(2.0 * np.abs(cross) / np.maximum(product, 1e-12))


def tangents(behind: Array, ahead: Array) -> Array:
    """Return the directions (n, 2) of the circles through points, by the steps (n, 2) to them and from them."""
    one, other = (np.maximum(np.hypot(*part.T), 1e-12)[:, None] for part in (behind, ahead))
    direction = behind * other / one + ahead * one / other
    return np.asarray(direction / np.maximum(np.hypot(*direction.T), 1e-12)[:, None])


def interpolated(grid: Array, cells: Array) -> Array:
    """Return values (n,) between those of a grid, by cubic convolution (Keys 1981); at its border those of the border.

    Parameters
    ----------
    grid : ndarray, shape (height, width)
    cells : ndarray, shape (n, 2)
        Columns and rows, whole numbers at the grid's values.
    """
    height, width = grid.shape
    first = np.floor(cells).astype(int)
    shares = cells - first
    found = np.zeros(cells.shape[0])
    columns, rows = (_cubic_weights(share) for share in shares.T)
    for i in range(4):
        row = np.clip(first[:, 1] + i - 1, 0, height - 1)
        for k in range(4):
            column = np.clip(first[:, 0] + k - 1, 0, width - 1)
            found += rows[i] * columns[k] * grid[row, column]
    return found


def _cubic_weights(share: Array) -> tuple[Array, ...]:
    """Return the weights of the two values before and the two after a place between the middle ones."""
    square, cube = share**2, share**3
    return (
        0.5 * (-cube + 2.0 * square - share),
        0.5 * (3.0 * cube - 5.0 * square + 2.0),
        0.5 * (-3.0 * cube + 4.0 * square + share),
        0.5 * (cube - square),
    )


def _slope(jacobian: Array, residuals: Array, movable: NDArray[np.bool_]) -> Array:
    """Return the gradient (2 n,) of half of the sum of squares, zero where nothing may move."""
    local = np.einsum("nrk,nr->nk", jacobian, residuals)
    slope = np.zeros(movable.size)
    for k in range(6):
        slope[k : k + 2 * local.shape[0] : 2] += local[:, k]
    return np.where(movable, slope, 0.0)


def _banded_step(jacobian: Array, _: Array, slope: Array, movable: NDArray[np.bool_], damping: float) -> Array:
    """Return the step (2 n,) from the normal equations, of which only the diagonals near the main one are not zero."""
    from scipy.linalg import solveh_banded

    count = jacobian.shape[0]
    masked = jacobian * np.stack([movable[k : k + 2 * count : 2] for k in range(6)], axis=-1)[:, None, :]
    local = np.einsum("nrk,nrl->nkl", masked, masked)
    bands = np.zeros((_BAND + 1, movable.size))
    for k in range(6):
        for other in range(k, 6):
            bands[_BAND - (other - k), other : other + 2 * count : 2] += local[:, k, other]
    diagonal = bands[_BAND]
    diagonal += damping * diagonal
    diagonal[diagonal <= 1e-12] = 1.0
    return np.asarray(solveh_banded(bands, -slope, check_finite=False))


def _dense_step(jacobian: Array, residuals: Array, slope: Array, movable: NDArray[np.bool_], damping: float) -> Array:
    """Return the step (2 n,) as the least-squares solution over the whole Jacobian."""
    count, size = jacobian.shape[0], movable.size
    whole = np.zeros((6 * count, size))
    for k in range(6):
        for row in range(6):
            whole[np.arange(count) * 6 + row, np.arange(count) * 2 + k] = jacobian[:, row, k]
    whole = whole[:, movable]
    damped = np.sqrt(damping) * np.diag(np.linalg.norm(whole, axis=0))
    target = np.concatenate([-residuals.ravel(), np.zeros(whole.shape[1])])
    step = np.zeros(size)
    step[movable] = np.linalg.lstsq(np.concatenate([whole, damped]), target, rcond=None)[0]
    return step
