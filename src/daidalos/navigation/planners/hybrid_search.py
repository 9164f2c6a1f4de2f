"""Hybrid-A*: search over poses with arcs of bounded curvature, its heuristics, and smoothing within the curvature.

D. Dolgov, S. Thrun, M. Montemerlo and J. Diebel, Practical search techniques in path planning for autonomous driving
(2008). Positions are in cells, whole numbers at centres; headings are in bins from that of the start, so that the start
is met exactly and the goal by a curve that ends the search.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import LETHAL_OBSTACLE, NO_INFORMATION, Costs
from daidalos.navigation.costmap.footprint import outline_cost
from daidalos.navigation.planners.curves import moved, sampled, shortest_curve
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, RUNNING, Prices, grown, pop, push

_SIZE, _NODES, _NEAREST, _ON_APPROACH, _COUNTDOWN, _GOAL, _HAS_CURVE = range(7)
CORNER = np.full(2, -0.5)
"""Outer corner of cell (0, 0), in cells."""
SPACING = 0.75
"""Distance [cells] between poses that are checked for collisions, and between those of a path."""
_RADIUS, _BIN, _RETROSPECTIVE, _REVERSE, _CHANGE, _TURN, _RATIO, _LENGTH, _COST, _REACH, _APPROACH, _WINDOW = range(12)


@dataclass(frozen=True)
class HybridOptions:
    """Options of a search; lengths are in cells.

    Attributes
    ----------
    radius : float
        Turning radius, at least 1.
    bins : int
        Headings.
    is_reverse_allowed : bool
    reverse_penalty, change_penalty, non_straight_penalty, retrospective_penalty : float
        See `SmacPlannerHybridParameters`.
    expansion_ratio, expansion_length, expansion_cost : float
        How often curves to the goal are tried, how long they may be, and the highest cost under them.
    is_cost_overridden : bool
        Whether that cost is ignored within a full turn of the goal.
    is_interpolated : bool
        Whether to have wider turns as well.
    reach : float
        Distance from the goal within which another pose may take its place.
    on_approach : int
        Poses that are expanded from the first one within reach on.
    table : ndarray of float32, shape (n, n // 2 + 1, bins)
        Lengths of shortest curves by relative pose, 0 where not known yet; they are filled in.
    """

    radius: float
    bins: int
    is_reverse_allowed: bool
    reverse_penalty: float
    change_penalty: float
    non_straight_penalty: float
    retrospective_penalty: float
    expansion_ratio: float
    expansion_length: float
    expansion_cost: float
    is_cost_overridden: bool
    is_interpolated: bool
    reach: float
    on_approach: int
    table: Prices

    def motions(self) -> Array:
        """Return signed lengths and turned bins (n, 2) of the motions, straight on first.

        The narrowest turn is the shortest arc of the radius that leaves a cell and turns by whole bins.
        """
        turned = 2.0 * math.pi / self.bins
        count = max(math.ceil(2.0 * math.asin(min(math.sqrt(0.5) / self.radius, 1.0)) / turned), 1)
        length = self.radius * turned * count
        turns = range(1, count + 1) if self.is_interpolated else (count,)
        forward = [(length, 0.0), *((length, float(sign * k)) for k in turns for sign in (1, -1))]
        backward = [(-s, -k) for s, k in forward] if self.is_reverse_allowed else []
        return np.array(forward + backward)


class HybridSearch:
    """Hybrid-A* from a pose to a pose, in steps that the caller counts.

    Parameters
    ----------
    costs : ndarray of uint8, shape (height, width)
    price : ndarray of float32, shape (256,)
        Price of a cell's length over a cell of each cost, 1 on free ground.
    polygon : ndarray, shape (n, 2)
        Corners of the footprint in cells; none of a round robot, which the inflated costs of its centre stand for.
    rest : ndarray of float32, shape (coarse height, coarse width)
        Costs to the goal of `costs_to_goal`.
    factor : int
        How many cells of the costmap an edge of one of `rest` has.
    start, goal : ndarray, shape (3,)
        Positions in cells and yaws [rad].
    options : HybridOptions
    """

    def __init__(
        self, costs: Costs, price: Prices, polygon: Array, rest: Prices, factor: int, start: Array, goal: Array,
        options: HybridOptions,
    ) -> None:  # fmt: skip
        self._costs, self._price, self._polygon, self._rest, self._factor = costs, price, polygon, rest, factor
        self._start, self._goal, self._options = start, goal, options
        o = options
        self._motions = o.motions()
        self._numbers = np.array(
            [
                o.radius, 2.0 * math.pi / o.bins, o.retrospective_penalty, o.reverse_penalty, o.change_penalty,
                o.non_straight_penalty, o.expansion_ratio, o.expansion_length, o.expansion_cost, o.reach,
                o.on_approach, 2.0 * math.pi * o.radius if o.is_cost_overridden else 0.0,
            ]
        )  # fmt: skip
        self._slots = np.zeros(costs.size * o.bins, dtype=np.int32)
        self._poses = np.array([[start[0], start[1], 0.0]])
        self._values, self._parents = np.zeros(1, dtype=np.float32), np.full(1, -1, dtype=np.int32)
        self._by, self._closed = np.zeros(1, dtype=np.int32), np.zeros(1, dtype=np.bool_)
        self._keys, self._items = np.zeros(1, dtype=np.float32), np.zeros(1, dtype=np.int32)
        self._state = np.array([1, 1, -1, 0, 0, -1, 0], dtype=np.int64)
        self._curve = np.zeros((2, 5))
        column, row = round(start[0]), round(start[1])
        self._slots[(row * costs.shape[1] + column) * o.bins] = 1

    def _between(self) -> Array:
        """Return poses (motions, n, 3) along each motion, from where it begins; the last is its end."""
        count = max(math.ceil(2.0 * abs(self._motions[0, 0]) / SPACING), 1)
        turned = 2.0 * math.pi / self._options.bins
        return np.array(
            [
                [moved(0.0, 0.0, 0.0, turn * turned / length, length * k / count) for k in range(1, count + 1)]
                for length, turn in self._motions
            ]
        )

    def advance(self, count: int) -> int:
        """Expand at most so many poses, and return the state of the search."""
        more = count * self._motions.shape[0]
        for name in ("_poses", "_values", "_parents", "_by", "_closed"):
            setattr(self, name, grown(getattr(self, name), int(self._state[_NODES]) + more))
        for name in ("_keys", "_items"):
            setattr(self, name, grown(getattr(self, name), int(self._state[_SIZE]) + more))
        return _advance(
            self._costs, self._price, self._polygon, self._rest, self._factor, self._start[2], self._goal,
            self._motions, self._between(), self._numbers, self._options.is_reverse_allowed, self._options.table,
            self._slots, self._poses, self._values, self._parents, self._by, self._closed, self._keys, self._items,
            self._state, self._curve, count,
        )  # fmt: skip

    def path(self) -> Array:
        """Return the poses (n, 3) of the path, positions in cells, once the search has found one."""
        node = int(self._state[_GOAL])
        way = []
        while node >= 0:
            way.append(node)
            node = int(self._parents[node])
        path = _driven(np.array(way[::-1]), self._poses, self._by, self._motions, self._start, self._options.bins)
        if self._state[_HAS_CURVE]:
            curve = sampled(
                self._curve[0], self._curve[1], self._options.radius, path[-1, 0], path[-1, 1], path[-1, 2], SPACING
            )
            path = np.concatenate([path, curve])
        return path


@compiled
def _driven(
    way: NDArray[np.int64], poses: Array, by: NDArray[np.int32], motions: Array, start: Array, bins: int
) -> Array:
    """Return the poses (n, 3) of the arcs from node to node, at most `SPACING` apart."""
    count = max(math.ceil(abs(motions[0, 0]) / SPACING), 1)
    path = np.empty((1 + count * (way.shape[0] - 1), 3))
    path[0] = start
    turned = 2.0 * math.pi / bins
    for i in range(1, way.shape[0]):
        x, y, heading = poses[way[i - 1]]
        length, turn = motions[by[way[i]]]
        for k in range(count):
            part = length * (k + 1) / count
            at = moved(x, y, start[2] + heading * turned, turn * turned / length, part)
            path[1 + (i - 1) * count + k, 0], path[1 + (i - 1) * count + k, 1] = at[0], at[1]
            path[1 + (i - 1) * count + k, 2] = at[2]
    return path


@compiled
def _advance(
    costs: Costs,
    price: Prices,
    polygon: Array,
    rest: Prices,
    factor: int,
    start_yaw: float,
    goal: Array,
    motions: Array,
    between: Array,
    numbers: Array,
    is_reverse_allowed: bool,
    table: Prices,
    slots: NDArray[np.int32],
    poses: Array,
    values: Prices,
    parents: NDArray[np.int32],
    by: NDArray[np.int32],
    closed: NDArray[np.bool_],
    keys: Prices,
    items: NDArray[np.int32],
    state: NDArray[np.int64],
    curve: Array,
    count: int,
) -> int:
    width = costs.shape[1]
    turned = numbers[_BIN]
    bins = round(2.0 * math.pi / turned)
    reach = numbers[_REACH]
    goal_column, goal_row = round(goal[0]), round(goal[1])
    goal_bin = round((goal[2] - start_yaw) / turned) % bins
    size, nodes, nearest = state[_SIZE], state[_NODES], state[_NEAREST]
    closest = reach
    if nearest >= 0:
        closest = math.hypot(poses[nearest, 0] - goal[0], poses[nearest, 1] - goal[1])
    finest = bins
    for motion in range(motions.shape[0]):
        if motions[motion, 1] > 0.0:
            finest = min(finest, round(motions[motion, 1]))
    found = RUNNING
    done = 0
    while done < count:
        if size == 0:
            found = FOUND if nearest >= 0 else EXHAUSTED
            break
        node = items[0]
        size = pop(keys, items, size)
        if closed[node]:
            continue
        closed[node] = True
        done += 1
        x, y, heading = poses[node, 0], poses[node, 1], round(poses[node, 2])
        yaw = start_yaw + heading * turned
        apart = math.hypot(x - goal[0], y - goal[1])
        turn_left = (heading - goal_bin) % bins
        is_turned = 2 * min(turn_left, bins - turn_left) <= finest
        if round(x) == goal_column and round(y) == goal_row and is_turned:
            nearest = node
            found = FOUND
            break
        if apart < closest:
            nearest, closest = node, apart
        if nearest >= 0:
            state[_ON_APPROACH] += 1
            if state[_ON_APPROACH] > numbers[_APPROACH]:
                found = FOUND
                break
        wait = max(apart / numbers[_RATIO], math.ceil(numbers[_RATIO]))
        state[_COUNTDOWN] = min(state[_COUNTDOWN] - 1, int(wait))
        if state[_COUNTDOWN] <= 0:
            state[_COUNTDOWN] = int(wait)
            if apart <= numbers[_LENGTH] and _reaches(
                costs, price, polygon, x, y, yaw, goal, numbers, is_reverse_allowed, curve
            ):
                nearest = node
                state[_HAS_CURVE] = 1
                found = FOUND
                break
        cosine, sine = math.cos(yaw), math.sin(yaw)
        for motion in range(motions.shape[0]):
            length, turn = motions[motion, 0], motions[motion, 1]
            along, across = between[motion, -1, 0], between[motion, -1, 1]
            there_x, there_y = x + cosine * along - sine * across, y + sine * along + cosine * across
            column, row = round(there_x), round(there_y)
            if column < 0 or row < 0 or column >= width or row >= costs.shape[0]:
                continue
            there_bin = (heading + round(turn)) % bins
            slot = (row * width + column) * bins + there_bin
            known = slots[slot] - 1
            if known >= 0 and closed[known]:
                continue
            one = price[costs[row, column]]
            step = abs(length) * (one - numbers[_RETROSPECTIVE])
            if turn != 0.0:
                before = motions[by[node], 1] * motions[by[node], 0]
                is_changed = parents[node] >= 0 and before * turn * length <= 0.0
                step *= numbers[_TURN] + (numbers[_CHANGE] if is_changed else 0.0)
            if length < 0.0:
                step *= numbers[_REVERSE]
            value = values[node] + step
            if known >= 0 and value >= values[known]:
                continue
            is_free = True
            for k in range(between.shape[1]):
                along, across = between[motion, k, 0], between[motion, k, 1]
                at_x, at_y = x + cosine * along - sine * across, y + sine * along + cosine * across
                if not stands_free(costs, price, polygon, at_x, at_y, yaw + between[motion, k, 2]):
                    is_free = False
                    break
            if not is_free:
                continue
            if known < 0:
                known = nodes
                nodes += 1
                slots[slot] = known + 1
                closed[known] = False
            poses[known, 0], poses[known, 1], poses[known, 2] = there_x, there_y, there_bin
            values[known], parents[known], by[known] = value, node, motion
            ahead = _rest(rest, factor, table, there_x, there_y, start_yaw + there_bin * turned, goal, numbers,
                          is_reverse_allowed)  # fmt: skip
            size = push(keys, items, size, value + ahead, known)
    state[_SIZE], state[_NODES], state[_NEAREST] = size, nodes, nearest
    if found == FOUND:
        state[_GOAL] = nearest
    return found


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
def _reaches(
    costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, goal: Array, numbers: Array,
    is_reverse_allowed: bool, curve: Array,
) -> bool:  # fmt: skip
    """Return whether the shortest curve to the goal is short, cheap and free; write it to `curve`."""
    radius = numbers[_RADIUS]
    cosine, sine = math.cos(yaw), math.sin(yaw)
    dx, dy = (goal[0] - x) / radius, (goal[1] - y) / radius
    total, turns, lengths = shortest_curve(
        cosine * dx + sine * dy, cosine * dy - sine * dx, goal[2] - yaw, is_reverse_allowed
    )
    if total * radius > numbers[_LENGTH]:
        return False
    poses = sampled(turns, lengths, radius, x, y, yaw, 0.5 * SPACING)
    is_limited = math.hypot(x - goal[0], y - goal[1]) > numbers[_WINDOW]
    for i in range(poses.shape[0]):
        if not stands_free(costs, price, polygon, poses[i, 0], poses[i, 1], poses[i, 2]):
            return False
        cost = costs[round(poses[i, 1]), round(poses[i, 0])]
        if is_limited and cost > numbers[_COST] and cost != NO_INFORMATION:
            return False
    curve[0], curve[1] = turns, lengths
    return True


@compiled
def _rest(
    rest: Prices, factor: int, table: Prices, x: float, y: float, yaw: float, goal: Array, numbers: Array,
    is_reverse_allowed: bool,
) -> float:  # fmt: skip
    """Return the estimated cost to the goal: the higher of those of obstacles and of curvature."""
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
    one = round(turn / numbers[_BIN]) % table.shape[2]
    length = table[column, row, one]
    if length == 0.0:
        angle = one * numbers[_BIN]
        dx, dy = -float(column - half) / numbers[_RADIUS], -float(row) / numbers[_RADIUS]
        cosine, sine = math.cos(angle), math.sin(angle)
        length, _, _ = shortest_curve(cosine * dx + sine * dy, cosine * dy - sine * dx, -angle, is_reverse_allowed)
        length = max(length * numbers[_RADIUS], 1e-3)
        table[column, row, one] = length
    return float(max(by_obstacles, length))


def blended(given: Array, smooth: Array, window: int, forbidden: Callable[[Array], NDArray[np.bool_]]) -> Array:
    """Return points as near to smoothed ones as is allowed, and the given ones at both ends.

    Parameters
    ----------
    given, smooth : ndarray, shape (n, 2)
        The given points are allowed.
    window : int
        Number of points on each side over which the share of the smoothed ones goes down to that at a forbidden point.
    forbidden : callable
        Returns which points of a path are not allowed.
    """
    index = np.arange(given.shape[0])
    share = np.clip((np.minimum(index, index[::-1]) - 1.0) / window, 0.0, 1.0)
    share *= share * (3.0 - 2.0 * share)
    fade = 1.0 - 0.5 * (1.0 + np.cos(np.pi * np.arange(-window, window + 1) / window))
    for _ in range(20):
        points = given + share[:, None] * (smooth - given)
        wrong = forbidden(points)
        if not wrong.any():
            return points
        factor = np.ones_like(share)
        for at in np.flatnonzero(wrong).tolist():
            low, high = max(at - window, 0), min(at + window + 1, share.size)
            part = fade[low - at + window : high - at + window]
            factor[low:high] = np.minimum(factor[low:high], part)
        share *= factor
    return given


@compiled
def are_forbidden(
    points: Array, costs: Costs, price: Prices, polygon: Array, is_backwards: bool, curvature: float
) -> NDArray[np.bool_]:
    """Return which points (n, 2) of a part of a path without cusps are bent too much, or the robot is in contact at."""
    count = points.shape[0]
    wrong = np.zeros(count, dtype=np.bool_)
    for i in range(1, count - 1):
        wrong[i] = _curvature(points, i) > curvature
    for i in range(count - 1):
        dx, dy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
        yaw = math.atan2(-dy, -dx) if is_backwards else math.atan2(dy, dx)
        for k in range(5):
            x, y = points[i, 0] + 0.25 * k * dx, points[i, 1] + 0.25 * k * dy
            if not stands_free(costs, price, polygon, x, y, yaw):
                wrong[i] = wrong[i + 1] = True
                break
    return wrong


@compiled
def _curvature(points: Array, i: int) -> float:
    """Return the curvature of the circle through a point and its two neighbours; infinite where they turn back."""
    ax, ay = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1]
    bx, by = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
    if ax * bx + ay * by <= 0.0:
        return np.inf
    return float(
        2.0 * abs(ax * by - ay * bx) / (math.hypot(ax, ay) * math.hypot(bx, by) * math.hypot(ax + bx, ay + by))
    )
