"""Hybrid-A*: search over poses with arcs of bounded curvature.

D. Dolgov, S. Thrun, M. Montemerlo and J. Diebel, Practical search techniques in path planning for autonomous driving
(2008). Positions are in cells, whole numbers at centres; headings are in bins from that of the start, so that the start
is met exactly and the goal by a curve that ends the search.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import Costs
from daidalos.navigation.planners.curves import moved, sampled
from daidalos.navigation.planners.goal_curves import (
    CURVES,
    REVERSIBLE_CURVES,
    SPACING,
    cost_to_nearest,
    drives_free,
    reached_goal,
)
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, RUNNING, Prices, grown, pop, push

_SIZE, _NODES, _NEAREST, _ON_APPROACH, _COUNTDOWN, _GOAL, _HAS_CURVE = range(7)
_RADIUS, _LENGTH, _COST, _WINDOW, _BIN, _RETROSPECTIVE, _REVERSE, _CHANGE, _TURN, _RATIO, _REACH, _APPROACH = range(12)


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
    coarse : int
        See `reached_goal`.
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
    coarse: int
    reach: float
    on_approach: int
    table: Prices

    @property
    def curve_kind(self) -> int:
        """The kind of curves to the goal."""
        return REVERSIBLE_CURVES if self.is_reverse_allowed else CURVES

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
    """Hybrid-A* from a pose to one of some poses at one place, in steps that the caller counts.

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
    start : ndarray, shape (3,)
    goals : ndarray, shape (m, 3)
        Positions in cells and yaws [rad].
    options : HybridOptions
    """

    def __init__(
        self, costs: Costs, price: Prices, polygon: Array, rest: Prices, factor: int, start: Array, goals: Array,
        options: HybridOptions,
    ) -> None:  # fmt: skip
        self._costs, self._price, self._polygon, self._rest, self._factor = costs, price, polygon, rest, factor
        self._start, self._goals, self._options = start, goals, options
        o = options
        self._motions = o.motions()
        self._numbers = np.array(
            [
                o.radius, o.expansion_length, o.expansion_cost,
                2.0 * math.pi * o.radius if o.is_cost_overridden else 0.0, 2.0 * math.pi / o.bins,
                o.retrospective_penalty, o.reverse_penalty, o.change_penalty, o.non_straight_penalty,
                o.expansion_ratio, o.reach, o.on_approach,
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
        count = max(math.ceil(abs(self._motions[0, 0]) / SPACING), 1)
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
            self._costs, self._price, self._polygon, self._rest, self._factor, self._start[2], self._goals,
            self._motions, self._between(), self._numbers, self._options.curve_kind, self._options.coarse,
            self._options.table, self._slots, self._poses, self._values, self._parents, self._by, self._closed,
            self._keys, self._items, self._state, self._curve, count,
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
    goals: Array,
    motions: Array,
    between: Array,
    numbers: Array,
    curve_kind: int,
    coarse: int,
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
    goal = goals[0]
    goal_column, goal_row = round(goal[0]), round(goal[1])
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
        is_there = round(x) == goal_column and round(y) == goal_row
        if is_there and _looks_along(heading, goals, start_yaw, turned, finest):
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
            reached = -1
            if apart <= numbers[_LENGTH]:
                reached = reached_goal(costs, price, polygon, x, y, yaw, goals, numbers[:4], curve_kind, coarse, curve)
            if reached >= 0:
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
            at_x, at_y, at_yaw = x, y, yaw
            for k in range(between.shape[1]):
                along, across = between[motion, k, 0], between[motion, k, 1]
                to_x, to_y = x + cosine * along - sine * across, y + sine * along + cosine * across
                to_yaw = yaw + between[motion, k, 2]
                if not drives_free(costs, price, polygon, at_x, at_y, at_yaw, to_x, to_y, to_yaw):
                    is_free = False
                    break
                at_x, at_y, at_yaw = to_x, to_y, to_yaw
            if not is_free:
                continue
            if known < 0:
                known = nodes
                nodes += 1
                slots[slot] = known + 1
                closed[known] = False
            poses[known, 0], poses[known, 1], poses[known, 2] = there_x, there_y, there_bin
            values[known], parents[known], by[known] = value, node, motion
            ahead = cost_to_nearest(
                rest, factor, table, there_x, there_y, start_yaw + there_bin * turned, goals, numbers[_RADIUS],
                curve_kind, np.inf,
            )  # fmt: skip
            size = push(keys, items, size, value + ahead, known)
    state[_SIZE], state[_NODES], state[_NEAREST] = size, nodes, nearest
    if found == FOUND:
        state[_GOAL] = nearest
    return found


@compiled
def _looks_along(heading: int, goals: Array, start_yaw: float, turned: float, finest: int) -> bool:
    """Return whether a bin is within half of the finest turn, in bins, of the heading of one of the goals."""
    bins = round(2.0 * math.pi / turned)
    for i in range(goals.shape[0]):
        left = (heading - round((goals[i, 2] - start_yaw) / turned)) % bins
        if 2 * min(left, bins - left) <= finest:
            return True
    return False
