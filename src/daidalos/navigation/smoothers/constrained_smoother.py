"""Constrained smoother: least squares over smoothness, the turning radius, costs and the distance from the path."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.navigation.contracts import Smoother
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import SmootherError
from daidalos.navigation.paths import distances_along
from daidalos.navigation.smoothers.path_optimization import Limits, Weights, optimize, tangents

DENSE, SPARSE = "DENSE_QR", "SPARSE_NORMAL_CHOLESKY"


@dataclass(frozen=True)
class OptimizerParameters(Parameters):
    """Parameters of the optimisation, by their Nav2 names."""

    linear_solver_type: str = parameter(SPARSE, "How each step is computed.", choices=(DENSE, SPARSE))
    param_tol: float = parameter(
        1e-15, "Step at which it ends, as a share of the norm of all coordinates.", minimum=0.0
    )
    fn_tol: float = parameter(1e-7, "Change of the sum of squares at which it ends, as a share of it.", minimum=0.0)
    gradient_tol: float = parameter(1e-10, "Largest slope of the sum of squares at which it ends.", minimum=0.0)
    max_iterations: int = parameter(100, "Largest number of iterations.", minimum=1)
    debug_optimizer: bool = parameter(False, "Whether iterations and sums of squares are logged.")


@dataclass(frozen=True)
class ConstrainedSmootherParameters(Parameters):
    """Parameters of the smoother, by their Nav2 names."""

    w_smooth: float = parameter(2_000_000.0, "Weight of smoothness.", minimum=0.0)
    w_curve: float = parameter(30.0, "Weight of curvature above that of the turning radius.", minimum=0.0)
    w_dist: float = parameter(0.0, "Weight of the distance from the given path.", minimum=0.0)
    w_cost: float = parameter(0.015, "Weight of the costs under the path.", minimum=0.0)
    w_cost_cusp_multiplier: float = parameter(3.0, "Factor of the weight of costs where it reverses.", minimum=0.0)
    cusp_zone_length: float = parameter(
        2.5, "Length of the part around such a place in which that weight rises.", unit="m", minimum=0.0
    )
    minimum_turning_radius: float = parameter(
        0.4, "Radius of the narrowest turn; 0 for a robot that turns in place.", unit="m", minimum=0.0
    )
    cost_check_points: tuple[float, ...] = parameter(
        (), "Places in the robot's frame under which costs are taken: x [m], y [m], weight, and so on."
    )
    path_downsampling_factor: int = parameter(1, "One of so many points of the path is moved.", minimum=1)
    path_upsampling_factor: int = parameter(
        1, "Points of the result for each of the path; 0 for those that were moved alone.", minimum=0
    )
    reversing_enabled: bool = parameter(
        True, "Whether the path's headings say where the robot drives backwards; otherwise it drives forward."
    )
    keep_goal_orientation: bool = parameter(True, "Whether the path ends at the heading of the given one.")
    keep_start_orientation: bool = parameter(True, "Whether the path begins at the heading of the given one.")
    optimizer: OptimizerParameters = group(OptimizerParameters)

    def check(self) -> None:
        """Check the points under which costs are taken."""
        if len(self.cost_check_points) % 3:
            raise ParameterError(
                "cost_check_points", f"must have three numbers for each point, got {len(self.cost_check_points)}"
            )
        shares = self.cost_check_points[2::3]
        if shares and not (min(shares) >= 0.0 and sum(shares) > 0.0):
            raise ParameterError("cost_check_points", "must have weights of at least 0, not all 0")

    @property
    def check_points(self) -> Array:
        """Places (n, 3) in the robot's frame with shares that add up to 1; the robot's centre where none are given."""
        if not self.cost_check_points:
            return np.array([[0.0, 0.0, 1.0]])
        points = np.reshape(self.cost_check_points, (-1, 3)).astype(np.float64)
        points[:, 2] = np.sqrt(points[:, 2]) / np.sqrt(points[:, 2]).sum()
        return points


class ConstrainedSmoother(Smoother):
    """Smoother that pulls a path away from costs, within a turning radius, also where the robot reverses.

    Weights hold for steps of a path in metres as those of Nav2's smoother do. Turns in place stay where they are; the
    parts between them are smoothed each on its own.
    """

    names = ("nav2_constrained_smoother::ConstrainedSmoother",)
    Parameters = ConstrainedSmootherParameters
    parameters: ConstrainedSmootherParameters

    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Implement `Smoother.smooth`."""
        if not np.isfinite(path).all():
            raise SmootherError("the path has numbers that are not finite")
        if path.shape[0] < 3:
            return path.copy()
        still = ~np.diff(path[:, :2], axis=0).any(axis=1)
        borders = sorted({0, path.shape[0], *(np.flatnonzero(still) + 1).tolist()})
        parts = []
        for begin, end in pairwise(borders):
            part = path[begin:end]
            parts.append(self._smoothed(part, costmap) if part.shape[0] > 2 else part)
        return np.concatenate(parts)

    def _smoothed(self, path: Array, costmap: Costmap) -> Array:
        """Smooth a path (n, 3) of at least three poses without turns in place."""
        p = self.parameters
        signs = _signs(path) if p.reversing_enabled else np.ones(path.shape[0] - 1)
        if not p.keep_start_orientation:
            signs[0] = signs[1]
        kept = _kept(signs, p.path_downsampling_factor, keep_start=p.keep_start_orientation,
                     keep_goal=p.keep_goal_orientation)  # fmt: skip
        points, signs = path[kept, :2], signs[kept[:-1]]
        fixed = np.zeros(kept.size, dtype=np.bool_)
        fixed[[0, -1]] = True
        fixed[1] |= p.keep_start_orientation
        fixed[-2] |= p.keep_goal_orientation
        limits = Limits(
            p.optimizer.max_iterations, p.optimizer.param_tol, p.optimizer.fn_tol, p.optimizer.gradient_tol,
            p.optimizer.linear_solver_type == DENSE,
        )  # fmt: skip
        outcome = optimize(points, signs, fixed, costmap, self._weights(points, signs), limits)
        if p.optimizer.debug_optimizer:
            self.context.warn(
                f"smoothed {kept.size} points in {outcome.iterations} iterations, "
                f"half the sum of squares {outcome.before:.6g} -> {outcome.after:.6g}"
            )
        yaws = _yaws(outcome.points, signs)
        yaws[0] = path[0, 2] if p.keep_start_orientation else yaws[0]
        yaws[-1] = path[-1, 2] if p.keep_goal_orientation else yaws[-1]
        poses = np.column_stack([outcome.points, yaws])
        if p.path_upsampling_factor == 0:
            return poses
        return upsampled(poses, signs, np.diff(kept) * p.path_upsampling_factor)

    def _weights(self, points: Array, signs: Array) -> Weights:
        """Return the weights of the points: those of costs rise towards the places at which the robot reverses."""
        p = self.parameters
        along = distances_along(points)
        share = np.zeros(along.size)
        for cusp in np.flatnonzero(signs[1:] != signs[:-1]) + 1:
            apart = np.abs(along - along[cusp])
            half = 0.5 * p.cusp_zone_length
            near = 1.0 - apart / half if half > 0.0 else (apart == 0.0).astype(np.float64)
            share = np.maximum(share, near)
        roots = p.w_cost**0.5 * (1.0 + share * (p.w_cost_cusp_multiplier**0.5 - 1.0))
        largest = 1.0 / p.minimum_turning_radius if p.minimum_turning_radius > 0.0 else np.inf
        return Weights(p.w_smooth, p.w_dist, p.w_curve, roots**2, largest, p.check_points)


def _signs(path: Array) -> Array:
    """Return the sign (n - 1,) of each step of a path: -1 where the robot looks against it."""
    steps = np.diff(path[:, :2], axis=0)
    ahead = steps[:, 0] * np.cos(path[:-1, 2]) + steps[:, 1] * np.sin(path[:-1, 2])
    return np.where(ahead < 0.0, -1.0, 1.0)


def _kept(signs: Array, factor: int, *, keep_start: bool, keep_goal: bool) -> NDArray[np.int64]:
    """Return the indices of the points that are optimised: one of `factor`, cusps, the ends and what sets headings."""
    count = signs.size + 1
    cusps = np.flatnonzero(signs[1:] != signs[:-1]) + 1
    ends = [0, count - 1] + ([1] if keep_start else []) + ([count - 2] if keep_goal else [])
    return np.unique(np.concatenate([np.arange(0, count, factor), cusps, ends]))


def _yaws(points: Array, signs: Array) -> Array:
    """Return the headings (n,) of points, along the circle through each and its neighbours."""
    steps = np.diff(points, axis=0)
    directions = np.empty(points.shape)
    directions[0], directions[-1] = steps[0], steps[-1]
    turned = np.where(signs[1:] == signs[:-1], 1.0, -1.0)[:, None]
    directions[1:-1] = tangents(steps[:-1], turned * steps[1:])
    directions[0] *= signs[0]
    directions[1:] *= signs[:, None]
    yaws: Array = np.arctan2(directions[:, 1], directions[:, 0])
    return yaws


def upsampled(poses: Array, signs: Array, counts: NDArray[np.int64]) -> Array:
    """Return poses with others between them, on cubic Bezier curves along their headings.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
    signs : ndarray, shape (n - 1,)
        Of the steps: -1 where the robot drives backwards.
    counts : ndarray, shape (n - 1,)
        Steps that each step becomes.
    """
    found = [poses[:1]]
    for (first, last), sign, count in zip(pairwise(poses), signs, counts, strict=True):
        if count == 1:
            found.append(last[None])
            continue
        reach = sign * float(np.hypot(*(last - first)[:2])) / 3.0
        inner = [one[:2] + side * reach * np.array([np.cos(one[2]), np.sin(one[2])]) for one, side in
                 ((first, 1.0), (last, -1.0))]  # fmt: skip
        share = np.arange(1, count + 1)[:, None] / count
        rest = 1.0 - share
        points = rest**3 * first[:2] + 3.0 * rest**2 * share * inner[0]
        points += 3.0 * rest * share**2 * inner[1] + share**3 * last[:2]
        slope = rest**2 * (inner[0] - first[:2]) + 2.0 * rest * share * (inner[1] - inner[0])
        slope = sign * (slope + share**2 * (last[:2] - inner[1]))
        part = np.column_stack([points, np.arctan2(slope[:, 1], slope[:, 0])])
        part[-1] = last
        found.append(part)
    return np.concatenate(found)
