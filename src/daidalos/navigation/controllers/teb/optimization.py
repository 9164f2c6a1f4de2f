"""Optimisation of a timed elastic band by least squares.

The band has poses (x, y, yaw) and the times between them. Its costs tie each pose to its two neighbours only: with four
unknowns a pose, the normal equations have a band of twelve, and a step of Levenberg and Marquardt costs a number of
operations linear in the number of poses. The costs are those of Rösmann et al., "Trajectory modification considering
dynamic constraints of autonomous robots" (ROBOTIK 2012) and "Integrated online trajectory planning and optimization in
distinctive topologies" (Robotics and Autonomous Systems 88, 2017).
"""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.localization.likelihood_map import Table
from daidalos.localization.refinement import interpolated
from daidalos.navigation.planners.curves import remainder

Indices = NDArray[np.int64]

WIDTH = 12
"""Width of the band of the normal equations: the unknowns of three poses."""

SHORTEST_TIME = 0.01
"""Least time [s] between two poses."""

(
    MAX_FORWARD, MAX_BACKWARD, MAX_SIDEWAYS, MAX_TURN, MAX_ACCELERATION, MAX_SIDE_ACCELERATION, MAX_TURN_ACCELERATION,
    TURNING_RADIUS, MARGIN, OBSTACLE_DISTANCE, INFLATION_DISTANCE, OBSTACLE_EXPONENT, EXACT_ARC, FREE_GOAL_SPEED,
    TURN_DIRECTION,
) = range(15)  # fmt: skip
"""Places of the limits in their array."""

(
    FORWARD, SIDEWAYS, TURN, ACCELERATION, SIDE_ACCELERATION, TURN_ACCELERATION, NONHOLONOMIC, FORWARD_DRIVE, RADIUS,
    TIME, LENGTH, OBSTACLE, INFLATION, VIA_POINT, PREFERRED_TURN,
) = range(15)  # fmt: skip
"""Places of the weights in theirs."""

TRIES = 6
"""Number of dampings that are tried in a step."""

_FIXED = 1e12
"""Addition to the diagonal that keeps an unknown."""

_PREFERRED = 3
"""Number of steps at the start in which a direction of turning is preferred."""


@compiled
def optimize(
    poses: Array,
    times: Array,
    velocity: Array,
    limits: Array,
    weights: Array,
    outline: Array,
    distance: Table,
    origin: Array,
    resolution: float,
    via_points: Array,
    nearest: Array,
    iterations: int,
) -> float:
    """Optimise a band in place, and return its cost.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        Poses (x, y, yaw); the first and the last one stay.
    times : ndarray, shape (n - 1,)
        Times [s] between them.
    velocity : ndarray, shape (3,)
        Present velocity (x, y, yaw) of the robot.
    limits, weights : ndarray
        See `MAX_FORWARD` and `FORWARD`.
    outline : ndarray, shape (k, 3)
        Circles (x, y, radius) [m] in the robot's frame that stand for it.
    distance : ndarray of float32, shape (height, width)
        Distance [m] of each cell of the costmap to the nearest obstacle.
    origin : ndarray, shape (2,)
        Outer corner of cell (0, 0) [m].
    resolution : float
        Side of a cell [m].
    via_points : ndarray, shape (m, 2)
        Points that the band shall come near to [m].
    nearest : ndarray, shape (m,)
        Index of the pose that each of them attracts.
    iterations : int
        Steps.
    """
    n = poses.shape[0]
    matrix, slope = np.zeros((4 * n, WIDTH)), np.zeros(4 * n)
    step = np.empty(4 * n)
    damping = 0.1
    new = 0.0
    cost = linearize(
        poses, times, velocity, limits, weights, outline, distance, origin, resolution, via_points, nearest,
        matrix, slope,
    )  # fmt: skip
    old_poses, old_times = poses.copy(), times.copy()
    next_matrix, next_slope = np.zeros((4 * n, WIDTH)), np.zeros(4 * n)
    for _ in range(iterations):
        for _ in range(TRIES):
            _solve(matrix, slope, damping, step)
            for k in range(n):
                for i in range(3):
                    poses[k, i] = old_poses[k, i] + step[4 * k + i]
                if k < n - 1:
                    times[k] = max(old_times[k] + step[4 * k + 3], SHORTEST_TIME)
            new = linearize(
                poses, times, velocity, limits, weights, outline, distance, origin, resolution, via_points, nearest,
                next_matrix, next_slope,
            )  # fmt: skip
            if new < cost:
                break
            damping = min(8.0 * damping, 1e6)
        if not new < cost:
            poses[:], times[:] = old_poses, old_times
            break
        gain = cost - new
        cost = new
        damping = max(0.2 * damping, 1e-6)
        matrix, next_matrix = next_matrix, matrix
        slope, next_slope = next_slope, slope
        old_poses[:], old_times[:] = poses, times
        if gain < 1e-6 * cost:
            break
    return cost


@compiled
def linearize(
    poses: Array,
    times: Array,
    velocity: Array,
    limits: Array,
    weights: Array,
    outline: Array,
    distance: Table,
    origin: Array,
    resolution: float,
    via_points: Array,
    nearest: Array,
    matrix: Array,
    slope: Array,
) -> float:
    """Compute the normal equations of a band, and return its cost; the parameters are those of `optimize`.

    `matrix` (4 n, 12) gets the diagonals of the symmetric matrix from the main one upwards, `slope` (4 n,) the
    gradient of half the cost.
    """
    n = poses.shape[0]
    matrix[:], slope[:] = 0.0, 0.0
    cost = 0.0
    index, row = np.empty(WIDTH, dtype=np.int64), np.empty(WIDTH)
    # Of two steps one after the other: the velocities (x, y, yaw), and their slopes by the unknowns of both.
    before, after = np.zeros(3), np.zeros(3)
    before_rows, after_rows = np.zeros((3, 7)), np.zeros((3, 7))
    for k in range(n - 1):
        _velocity_of_step(poses, times, k, limits[EXACT_ARC] > 0.0, after, after_rows)
        cost += _limit_velocity(k, after, after_rows, limits, weights, matrix, slope, index, row)
        cost += _keep_to_kinematics(poses, k, limits, weights, matrix, slope, index, row)
        for axis in range(3):
            weight = weights[ACCELERATION + axis]
            most = limits[MAX_ACCELERATION + axis]
            limit = max(most - limits[MARGIN], 0.5 * most)
            if k == 0:
                cost += _accelerate_from(
                    axis, velocity[axis], times[0], after, after_rows, limit, weight, matrix, slope, index, row
                )
            else:
                cost += _accelerate(
                    k, axis, times, before, before_rows, after, after_rows, limit, weight, matrix, slope, index, row
                )
            if k == n - 2 and limits[FREE_GOAL_SPEED] == 0.0:
                cost += _brake(k, axis, times[k], after, after_rows, limit, weight, matrix, slope, index, row)
        cost += weights[TIME] * times[k] * times[k]
        slope[4 * k + 3] += weights[TIME] * times[k]
        matrix[4 * k + 3, 0] += weights[TIME]
        before[:], before_rows[:] = after, after_rows
    at_start, _, _, _ = clearance(poses[0], outline, distance, origin, resolution)
    at_end, _, _, _ = clearance(poses[n - 1], outline, distance, origin, resolution)
    for k in range(1, n - 1):
        cost += _avoid(
            k, poses, at_start, at_end, outline, distance, origin, resolution, limits, weights,
            matrix, slope, index, row,
        )  # fmt: skip
    for i in range(via_points.shape[0]):
        k = int(nearest[i])
        for axis in range(2):
            away = poses[k, axis] - via_points[i, axis]
            cost += weights[VIA_POINT] * away * away
            slope[4 * k + axis] += weights[VIA_POINT] * away
            matrix[4 * k + axis, 0] += weights[VIA_POINT]
    for i in range(3):
        for fixed in (i, 4 * n - 4 + i):
            matrix[fixed, 0] += _FIXED
            slope[fixed] = 0.0
    matrix[4 * n - 1, 0] += _FIXED
    return cost


@compiled
def _velocity_of_step(poses: Array, times: Array, k: int, exact: bool, velocity: Array, rows: Array) -> None:
    """Compute the velocity (x, y, yaw) of a step, and its slopes by (x, y, yaw, time) and the next (x, y, yaw)."""
    dx, dy = poses[k + 1, 0] - poses[k, 0], poses[k + 1, 1] - poses[k, 1]
    turn = remainder(poses[k + 1, 2] - poses[k, 2])
    middle = poses[k, 2] + 0.5 * turn
    cosine, sine = math.cos(middle), math.sin(middle)
    time = times[k]
    stretch = 1.0
    if exact and abs(turn) > 1e-4:
        stretch = 0.5 * turn / math.sin(0.5 * turn)
    rate = stretch / time
    forward, left = rate * (cosine * dx + sine * dy), rate * (cosine * dy - sine * dx)
    velocity[0], velocity[1], velocity[2] = forward, left, turn / time
    rows[0, 0], rows[0, 1], rows[0, 2], rows[0, 3] = -rate * cosine, -rate * sine, 0.5 * left, -forward / time
    rows[0, 4], rows[0, 5], rows[0, 6] = rate * cosine, rate * sine, 0.5 * left
    rows[1, 0], rows[1, 1], rows[1, 2], rows[1, 3] = rate * sine, -rate * cosine, -0.5 * forward, -left / time
    rows[1, 4], rows[1, 5], rows[1, 6] = -rate * sine, rate * cosine, -0.5 * forward
    rows[2, 0], rows[2, 1], rows[2, 2], rows[2, 3] = 0.0, 0.0, -1.0 / time, -turn / (time * time)
    rows[2, 4], rows[2, 5], rows[2, 6] = 0.0, 0.0, 1.0 / time


@compiled
def _add(matrix: Array, slope: Array, index: Indices, row: Array, count: int, residual: float, weight: float) -> float:
    """Add a residual with its slopes by some unknowns; return its cost."""
    for a in range(count):
        i, value = index[a], weight * row[a]
        slope[i] += value * residual
        for b in range(count):
            j = index[b]
            if j >= i:
                matrix[i, j - i] += value * row[b]
    return weight * residual * residual


@compiled
def _excess(value: float, low: float, high: float) -> tuple[float, float]:
    """Return by how much a value leaves an interval, and the sign of the slope."""
    if value > high:
        return value - high, 1.0
    if value < low:
        return low - value, -1.0
    return 0.0, 0.0


@compiled
def _limit_velocity(
    k: int,
    velocity: Array,
    rows: Array,
    limits: Array,
    weights: Array,
    matrix: Array,
    slope: Array,
    index: Indices,
    row: Array,
) -> float:
    margin = limits[MARGIN]
    cost = 0.0
    for axis in range(3):
        high = limits[MAX_FORWARD] if axis == 0 else limits[MAX_SIDEWAYS] if axis == 1 else limits[MAX_TURN]
        low = -limits[MAX_BACKWARD] if axis == 0 else -high
        if axis == 1 and high == 0.0:
            continue
        # As much as the margin of a limit that is smaller than the margin would leave nothing.
        residual, sign = _excess(velocity[axis], min(low + margin, 0.0), max(high - margin, 0.5 * high))
        if sign == 0.0:
            continue
        for i in range(7):
            index[i] = 4 * k + i
            row[i] = sign * rows[axis, i]
        cost += _add(matrix, slope, index, row, 7, residual, weights[FORWARD + axis])
    return cost


@compiled
def _accelerate_from(
    axis: int,
    velocity: float,
    time: float,
    after: Array,
    rows: Array,
    limit: float,
    weight: float,
    matrix: Array,
    slope: Array,
    index: Indices,
    row: Array,
) -> float:
    """Limit the acceleration from the present velocity."""
    value = (after[axis] - velocity) / time
    residual, sign = _excess(value, -limit, limit)
    if sign == 0.0 or weight == 0.0:
        return 0.0
    for i in range(7):
        index[i] = i
        row[i] = sign * rows[axis, i] / time
    row[3] -= sign * value / time
    return _add(matrix, slope, index, row, 7, residual, weight)


@compiled
def _brake(
    k: int,
    axis: int,
    time: float,
    after: Array,
    rows: Array,
    limit: float,
    weight: float,
    matrix: Array,
    slope: Array,
    index: Indices,
    row: Array,
) -> float:
    """Limit the deceleration to rest at the end."""
    value = -after[axis] / time
    residual, sign = _excess(value, -limit, limit)
    if sign == 0.0 or weight == 0.0:
        return 0.0
    for i in range(7):
        index[i] = 4 * k + i
        row[i] = -sign * rows[axis, i] / time
    row[3] -= sign * value / time
    return _add(matrix, slope, index, row, 7, residual, weight)


@compiled
def _accelerate(
    k: int,
    axis: int,
    times: Array,
    before: Array,
    before_rows: Array,
    after: Array,
    after_rows: Array,
    limit: float,
    weight: float,
    matrix: Array,
    slope: Array,
    index: Indices,
    row: Array,
) -> float:
    """Limit the acceleration between two steps."""
    span = 0.5 * (times[k - 1] + times[k])
    value = (after[axis] - before[axis]) / span
    residual, sign = _excess(value, -limit, limit)
    if sign == 0.0 or weight == 0.0:
        return 0.0
    first = 4 * (k - 1)
    for i in range(11):
        index[i] = first + i
        row[i] = 0.0
    for i in range(7):
        row[i] -= sign * before_rows[axis, i] / span
        row[4 + i] += sign * after_rows[axis, i] / span
    row[3] -= 0.5 * sign * value / span
    row[7] -= 0.5 * sign * value / span
    return _add(matrix, slope, index, row, 11, residual, weight)


@compiled
def _keep_to_kinematics(
    poses: Array, k: int, limits: Array, weights: Array, matrix: Array, slope: Array, index: Indices, row: Array
) -> float:
    """Keep a step to an arc, ahead, no tighter than the turning radius, short, and in the preferred direction."""
    dx, dy = poses[k + 1, 0] - poses[k, 0], poses[k + 1, 1] - poses[k, 1]
    turn = remainder(poses[k + 1, 2] - poses[k, 2])
    middle = poses[k, 2] + 0.5 * turn
    cosine, sine = math.cos(middle), math.sin(middle)
    ahead, left = cosine * dx + sine * dy, cosine * dy - sine * dx
    first = 4 * k
    index[0], index[1], index[2] = first, first + 1, first + 2
    index[3], index[4], index[5] = first + 4, first + 5, first + 6
    cost = 0.0
    if limits[MAX_SIDEWAYS] == 0.0:
        row[0], row[1], row[2] = sine, -cosine, -0.5 * ahead
        row[3], row[4], row[5] = -sine, cosine, -0.5 * ahead
        cost += _add(matrix, slope, index, row, 6, left, 4.0 * weights[NONHOLONOMIC])
        if ahead < 0.0:
            row[0], row[1], row[2] = cosine, sine, -0.5 * left
            row[3], row[4], row[5] = -cosine, -sine, -0.5 * left
            cost += _add(matrix, slope, index, row, 6, -ahead, weights[FORWARD_DRIVE])
    radius = limits[TURNING_RADIUS]
    length = math.hypot(dx, dy)
    if radius > 0.0 and abs(turn) * radius > length and length > 1e-9:
        side = math.copysign(radius, turn)
        row[0], row[1], row[2] = dx / length, dy / length, -side
        row[3], row[4], row[5] = -dx / length, -dy / length, side
        cost += _add(matrix, slope, index, row, 6, abs(turn) * radius - length, weights[RADIUS])
    if weights[LENGTH] > 0.0 and length > 1e-9:
        row[0], row[1], row[2] = -dx / length, -dy / length, 0.0
        row[3], row[4], row[5] = dx / length, dy / length, 0.0
        cost += _add(matrix, slope, index, row, 6, length, weights[LENGTH])
    direction = limits[TURN_DIRECTION]
    if direction != 0.0 and k < _PREFERRED and direction * turn < 0.0:
        row[:6] = 0.0
        row[2], row[5] = direction, -direction
        cost += _add(matrix, slope, index, row, 6, -direction * turn, weights[PREFERRED_TURN])
    return cost


@compiled
def clearance(
    pose: Array, outline: Array, distance: Table, origin: Array, resolution: float
) -> tuple[float, float, float, float]:
    """Return the distance [m] of a robot's outline to the nearest obstacle, and its slopes by x, y and yaw."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    nearest, gx, gy, turn = 1e3, 0.0, 0.0, 0.0
    for i in range(outline.shape[0]):
        dx = cosine * outline[i, 0] - sine * outline[i, 1]
        dy = sine * outline[i, 0] + cosine * outline[i, 1]
        away, sx, sy = interpolated(
            distance, (pose[0] + dx - origin[0]) / resolution, (pose[1] + dy - origin[1]) / resolution
        )
        if away - outline[i, 2] < nearest:
            nearest = away - outline[i, 2]
            gx, gy = sx / resolution, sy / resolution
            turn = gy * dx - gx * dy
    return nearest, gx, gy, turn


@compiled
def _avoid(
    k: int,
    poses: Array,
    at_start: float,
    at_end: float,
    outline: Array,
    distance: Table,
    origin: Array,
    resolution: float,
    limits: Array,
    weights: Array,
    matrix: Array,
    slope: Array,
    index: Indices,
    row: Array,
) -> float:
    """Keep a pose away from obstacles.

    Near an end of the band that is nearer to them than wanted, as much is wanted as there is at that end and a half of
    the distance from it: otherwise the poses would stay away from such a goal, and leap to it at last.
    """
    away, gx, gy, turn = clearance(poses[k], outline, distance, origin, resolution)
    index[0], index[1], index[2] = 4 * k, 4 * k + 1, 4 * k + 2
    least, exponent = limits[OBSTACLE_DISTANCE], limits[OBSTACLE_EXPONENT]
    cost = 0.0
    wanted, wx, wy = _wanted_clearance(least + limits[MARGIN], k, poses, at_start, at_end)
    missing = wanted - away
    if missing > 0.0:
        scale = 1.0
        if exponent != 1.0 and least > 0.0:
            scale = exponent * (missing / least) ** (exponent - 1.0)
            missing = least * (missing / least) ** exponent
        row[0], row[1], row[2] = scale * (wx - gx), scale * (wy - gy), -scale * turn
        cost += _add(matrix, slope, index, row, 3, missing, weights[OBSTACLE])
    wanted, wx, wy = _wanted_clearance(limits[INFLATION_DISTANCE], k, poses, at_start, at_end)
    missing = wanted - away
    if missing > 0.0 and limits[INFLATION_DISTANCE] > least:
        row[0], row[1], row[2] = wx - gx, wy - gy, -turn
        cost += _add(matrix, slope, index, row, 3, missing, weights[INFLATION])
    return cost


@compiled
def _wanted_clearance(
    wanted: float, k: int, poses: Array, at_start: float, at_end: float
) -> tuple[float, float, float]:
    """Return the wanted distance [m] of a pose to obstacles, and its slopes by x and y."""
    last = poses.shape[0] - 1
    gx, gy = 0.0, 0.0
    for end, there in ((0, at_start), (last, at_end)):
        dx, dy = poses[k, 0] - poses[end, 0], poses[k, 1] - poses[end, 1]
        length = math.hypot(dx, dy)
        if there + 0.5 * length < wanted:
            wanted = there + 0.5 * length
            gx, gy = (0.5 * dx / length, 0.5 * dy / length) if length > 1e-9 else (0.0, 0.0)
    return wanted, gx, gy


@compiled
def _solve(matrix: Array, slope: Array, damping: float, step: Array) -> None:
    """Solve the damped normal equations for a step by Cholesky decomposition within the band."""
    n = slope.shape[0]
    factor = matrix.copy()
    for i in range(n):
        factor[i, 0] += damping * matrix[i, 0] + 1e-9
    for i in range(n):
        pivot = math.sqrt(max(factor[i, 0], 1e-12))
        factor[i, 0] = pivot
        last = min(WIDTH, n - i)
        for a in range(1, last):
            factor[i, a] /= pivot
        for a in range(1, last):
            value = factor[i, a]
            if value != 0.0:
                for b in range(a, last):
                    factor[i + a, b - a] -= value * factor[i, b]
    for i in range(n):
        value = -slope[i]
        for a in range(1, min(WIDTH, i + 1)):
            value -= factor[i - a, a] * step[i - a]
        step[i] = value / factor[i, 0]
    for i in range(n - 1, -1, -1):
        value = step[i]
        for a in range(1, min(WIDTH, n - i)):
            value -= factor[i, a] * step[i + a]
        step[i] = value / factor[i, 0]
