"""Ends of searches over poses: where the robot can stand, curves to the goal, and the estimated cost to it."""

from __future__ import annotations

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import LETHAL_OBSTACLE, NO_INFORMATION, Costs
from daidalos.navigation.costmap.footprint import outline_cost
from daidalos.navigation.planners.curves import remainder, sampled, shortest_curve
from daidalos.navigation.planners.search import Prices

CORNER = np.full(2, -0.5)
"""Outer corner of cell (0, 0), in cells."""
SPACING = 0.75
"""Distance [cells] between poses that are checked for collisions, and between those of a path."""
CURVES, REVERSIBLE_CURVES, STRAIGHT = range(3)
"""Kinds of curves to goals: Dubins, Reeds-Shepp, and straight lines of robots that go to every side."""


@compiled
def stands_free(costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float) -> bool:
    """Return whether the robot at a pose, its position in cells, touches neither an obstacle nor the map's border."""
    column, row = round(x), round(y)
    if column < 0 or row < 0 or column >= costs.shape[1] or row >= costs.shape[0]:
        return False
    if price[costs[row, column]] == np.inf:
        return False
    if polygon.shape[0] == 0:
        return True
    cost = outline_cost(costs, 1.0, CORNER, polygon, x, y, yaw)
    return cost != LETHAL_OBSTACLE and (cost != NO_INFORMATION or price[NO_INFORMATION] < np.inf)


@compiled
def drives_free(
    costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, to_x: float, to_y: float, to_yaw: float
) -> bool:
    """Return whether the robot touches nothing on a straight step of at most a cell, its first pose left out."""
    if not crosses_free(costs, price, x, y, to_x, to_y):
        return False
    if polygon.shape[0] > 0:
        half = yaw + 0.5 * remainder(to_yaw - yaw)
        if not stands_free(costs, price, polygon, 0.5 * (x + to_x), 0.5 * (y + to_y), half):
            return False
    return stands_free(costs, price, polygon, to_x, to_y, to_yaw)


@compiled
def crosses_free(costs: Costs, price: Prices, x: float, y: float, to_x: float, to_y: float) -> bool:
    """Return whether the cell that a step of at most a cell passes between its two ends, if any, is passable."""
    column, row, to_column, to_row = round(x), round(y), round(to_x), round(to_y)
    if column == to_column or row == to_row:
        return True
    if min(to_column, to_row) < 0 or to_column >= costs.shape[1] or to_row >= costs.shape[0]:
        return False
    at_column = (0.5 * (column + to_column) - x) / (to_x - x)
    at_row = (0.5 * (row + to_row) - y) / (to_y - y)
    if at_column < at_row:
        return bool(price[costs[row, to_column]] < np.inf)
    return bool(price[costs[to_row, column]] < np.inf)


@compiled
def reaches(
    costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, goal: Array, limits: Array,
    is_reverse_allowed: bool, curve: Array,
) -> bool:  # fmt: skip
    """Return whether the shortest curve to a pose is short, cheap and free; write its turns and lengths to `curve`.

    Parameters
    ----------
    costs, price, polygon
        See `stands_free`.
    x, y, yaw : float
        Where it begins, the position in cells.
    goal : ndarray, shape (3,)
    limits : ndarray, shape (4,)
        The turning radius, the largest length, the highest cost, and the distance within which any cost will do.
    is_reverse_allowed : bool
    curve : ndarray, shape (2, 5)
    """
    radius = limits[0]
    cosine, sine = math.cos(yaw), math.sin(yaw)
    dx, dy = (goal[0] - x) / radius, (goal[1] - y) / radius
    total, turns, lengths = shortest_curve(
        cosine * dx + sine * dy, cosine * dy - sine * dx, goal[2] - yaw, is_reverse_allowed
    )
    if total * radius > limits[1]:
        return False
    poses = sampled(turns, lengths, radius, x, y, yaw, SPACING)
    is_limited = math.hypot(x - goal[0], y - goal[1]) > limits[3]
    for i in range(poses.shape[0]):
        if not drives_free(costs, price, polygon, x, y, yaw, poses[i, 0], poses[i, 1], poses[i, 2]):
            return False
        x, y, yaw = poses[i]
        cost = costs[round(poses[i, 1]), round(poses[i, 0])]
        if is_limited and cost > limits[2] and cost != NO_INFORMATION:
            return False
    curve[0], curve[1] = turns, lengths
    return True


@compiled
def cost_to_go(
    rest: Prices, factor: int, table: Prices, x: float, y: float, yaw: float, goal: Array, radius: float,
    is_reverse_allowed: bool,
) -> float:  # fmt: skip
    """Return the estimated cost to the goal: the higher of those of obstacles and of curvature.

    Parameters
    ----------
    rest : ndarray of float32, shape (coarse height, coarse width)
        Costs to the goal of `costs_to_goal`.
    factor : int
        How many cells of the costmap an edge of one of `rest` has.
    table : ndarray of float32, shape (n, n // 2 + 1, bins)
        Lengths of shortest curves by relative pose, 0 where not known yet; they are filled in.
    x, y, yaw : float
        A pose, its position in cells.
    goal : ndarray, shape (3,)
    radius : float
        Turning radius in cells.
    is_reverse_allowed : bool
    """
    turned = 2.0 * math.pi / table.shape[2]
    by_obstacles = rest[round(y) // factor, round(x) // factor]
    cosine, sine = math.cos(goal[2]), math.sin(goal[2])
    dx, dy = x - goal[0], y - goal[1]
    half = table.shape[0] // 2
    along, across = cosine * dx + sine * dy, cosine * dy - sine * dx
    turn = yaw - goal[2]
    if across < 0.0:  # the mirrored pose is as far
        across, turn = -across, -turn
    column, row = round(along) + half, round(across)
    if column < 0 or column >= table.shape[0] or row >= table.shape[1]:
        return float(by_obstacles)
    one = round(turn / turned) % table.shape[2]
    length = table[column, row, one]
    if length == 0.0:
        angle = one * turned
        dx, dy = -float(column - half) / radius, -float(row) / radius
        cosine, sine = math.cos(angle), math.sin(angle)
        length, _, _ = shortest_curve(cosine * dx + sine * dy, cosine * dy - sine * dx, -angle, is_reverse_allowed)
        length = max(length * radius, 1e-3)
        table[column, row, one] = length
    return float(max(by_obstacles, length))


@compiled
def reached_goal(
    costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, goals: Array, limits: Array,
    curve_kind: int, coarse: int, curve: Array,
) -> int:  # fmt: skip
    """Return the goal with the shortest curve that can be driven, -1 if there is none; write the curve.

    Parameters
    ----------
    costs, price, polygon
        See `stands_free`.
    x, y, yaw : float
        Where it begins, the position in cells.
    goals : ndarray, shape (n, 3)
        Poses at one place.
    limits : ndarray, shape (4,)
        See `reaches`.
    curve_kind : int
        `CURVES`, `REVERSIBLE_CURVES` or `STRAIGHT`.
    coarse : int
        How many goals on is the next that curves are tried to first; those beside the best of them follow.
    curve : ndarray, shape (2, 5)
    """
    found, shortest = -1, np.inf
    one = np.zeros((2, 5))
    middle = -1
    for turn in range(2):
        for i in range(goals.shape[0]):
            is_coarse = i % coarse == 0
            if is_coarse != (turn == 0):
                continue
            if turn == 1 and (
                middle < 0 or min((i - middle) % goals.shape[0], (middle - i) % goals.shape[0]) >= coarse
            ):
                continue
            if curve_kind == STRAIGHT:
                is_free = _reaches_straight(costs, price, polygon, x, y, yaw, goals[i], limits)
                length = math.hypot(goals[i, 0] - x, goals[i, 1] - y)
                length += abs(remainder(goals[i, 2] - yaw)) * 1e-3
            else:
                is_reversible = curve_kind == REVERSIBLE_CURVES
                is_free = reaches(costs, price, polygon, x, y, yaw, goals[i], limits, is_reversible, one)
                length = np.abs(one[1]).sum() * limits[0]
            if is_free and length < shortest:
                found, shortest = i, length
                curve[:] = one
        middle = found
    return found


@compiled
def _reaches_straight(
    costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, goal: Array, limits: Array
) -> bool:
    """Return whether a holonomic robot can go straight to a goal while it turns, within the limits of curves."""
    is_limited = math.hypot(x - goal[0], y - goal[1]) > limits[3]
    poses = straight_poses(x, y, yaw, goal, limits[0])
    for i in range(poses.shape[0]):
        if not drives_free(costs, price, polygon, x, y, yaw, poses[i, 0], poses[i, 1], poses[i, 2]):
            return False
        cost = costs[round(poses[i, 1]), round(poses[i, 0])]
        if is_limited and cost > limits[2] and cost != NO_INFORMATION:
            return False
        x, y, yaw = poses[i]
    return True


@compiled
def straight_poses(x: float, y: float, yaw: float, goal: Array, radius: float) -> Array:
    """Return poses (n, 3) on the line to a goal while the robot turns, the first left out, at most `SPACING` apart."""
    turn = remainder(goal[2] - yaw)
    length = math.hypot(goal[0] - x, goal[1] - y)
    count = max(math.ceil(max(length, abs(turn) * radius) / SPACING - 1e-9), 1)
    poses = np.empty((count, 3))
    for k in range(count):
        share = (k + 1) / count
        poses[k, 0], poses[k, 1] = x + share * (goal[0] - x), y + share * (goal[1] - y)
        poses[k, 2] = yaw + share * turn
    return poses


@compiled
def cost_to_nearest(
    rest: Prices, factor: int, table: Prices, x: float, y: float, yaw: float, goals: Array, radius: float,
    curve_kind: int, rotation: float,
) -> float:  # fmt: skip
    """Return the estimated cost to the nearest of some goals at one place; see `cost_to_go`.

    Obstacles alone count for straight curves and for more than two goals, which there are for any heading.

    Parameters
    ----------
    rest, factor, table, x, y, yaw, radius
        See `cost_to_go`.
    goals : ndarray, shape (n, 3)
    curve_kind : int
        `CURVES`, `REVERSIBLE_CURVES` or `STRAIGHT`.
    rotation : float
        Cost of a turn in place; infinite for robots that cannot.
    """
    by_obstacles = float(rest[round(y) // factor, round(x) // factor])
    if curve_kind == STRAIGHT or goals.shape[0] > 2:
        return by_obstacles
    least = np.inf
    for i in range(goals.shape[0]):
        one = cost_to_go(rest, factor, table, x, y, yaw, goals[i], radius, curve_kind == REVERSIBLE_CURVES)
        least = min(least, one)
    least = min(least, math.hypot(x - goals[0, 0], y - goals[0, 1]) + rotation)
    return max(by_obstacles, least)
