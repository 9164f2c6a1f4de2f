"""State lattice A*: search over poses of a lattice with its motions.

M. Pivtoraiko, R. Knepper and A. Kelly, Differentially constrained mobile robot motion planning in state lattices
(2009). The lattice is laid through the start, which it meets exactly; the goal is met by a curve that ends the search.
Positions are in cells of the costmap, whole numbers at centres; nodes are whole numbers of cells of the lattice.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import Costs
from daidalos.navigation.planners.curves import remainder, sampled
from daidalos.navigation.planners.goal_curves import (
    CURVES,
    REVERSIBLE_CURVES,
    SPACING,
    STRAIGHT,
    cost_to_nearest,
    drives_free,
    reached_goal,
    straight_poses,
)
from daidalos.navigation.planners.lattice_motions import LatticeMotions
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, RUNNING, Prices, grown, pop, push

_SIZE, _NODES, _NEAREST, _ON_APPROACH, _COUNTDOWN, _GOAL, _CURVE_TO = range(7)
(
    _RADIUS, _LENGTH, _COST, _WINDOW, _RETROSPECTIVE, _REVERSE, _CHANGE, _TURN, _ROTATION, _RATIO, _REACH, _APPROACH,
    _START_X, _START_Y, _START_YAW, _SCALE,
) = range(16)  # fmt: skip
_END_COLUMN, _END_ROW, _END_HEADING, _SIDE, _IS_REVERSE = range(5)


@dataclass(frozen=True)
class LatticeSearchOptions:
    """Options of a search; lengths are in cells of the costmap.

    Attributes
    ----------
    radius : float
        Turning radius.
    is_reverse_allowed, is_holonomic : bool
        Whether curves to the goal may go backwards, and whether they are straight lines at any heading.
    reverse_penalty, change_penalty, non_straight_penalty, rotation_penalty, retrospective_penalty : float
        See `SmacPlannerLatticeParameters`.
    expansion_ratio, expansion_length, expansion_cost : float
        How often curves to the goal are tried, how long they may be, and the highest cost under them.
    is_cost_overridden : bool
        Whether that cost is ignored within a full turn of the goal.
    coarse : int
        How many goals on are the next ones that curves are tried to before those between them.
    reach : float
        Distance from the goal within which another pose may take its place.
    on_approach : int
        Poses that are expanded from the first one within reach on.
    can_rotate : bool
        Whether there are motions that turn in place.
    table : ndarray of float32, shape (n, n // 2 + 1, bins)
        Lengths of shortest curves by relative pose, 0 where not known yet; they are filled in.
    """

    radius: float
    is_reverse_allowed: bool
    is_holonomic: bool
    reverse_penalty: float
    change_penalty: float
    non_straight_penalty: float
    rotation_penalty: float
    retrospective_penalty: float
    expansion_ratio: float
    expansion_length: float
    expansion_cost: float
    is_cost_overridden: bool
    coarse: int
    reach: float
    on_approach: int
    can_rotate: bool
    table: Prices

    @property
    def curve_kind(self) -> int:
        """The kind of curves to the goal."""
        if self.is_holonomic:
            return STRAIGHT
        return REVERSIBLE_CURVES if self.is_reverse_allowed else CURVES


class LatticeSearch:
    """State lattice A* from a pose to one of some poses at one place, in steps that the caller counts.

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
    motions : LatticeMotions
        From the start's heading.
    options : LatticeSearchOptions
    """

    def __init__(
        self, costs: Costs, price: Prices, polygon: Array, rest: Prices, factor: int, start: Array, goals: Array,
        motions: LatticeMotions, options: LatticeSearchOptions,
    ) -> None:  # fmt: skip
        self._costs, self._price, self._polygon, self._rest, self._factor = costs, price, polygon, rest, factor
        self._start, self._goals, self._motions, self._options = start, goals, motions, options
        o = options
        self._numbers = np.array(
            [
                o.radius, o.expansion_length, o.expansion_cost,
                2.0 * math.pi * o.radius if o.is_cost_overridden else 0.0, o.retrospective_penalty, o.reverse_penalty,
                o.change_penalty, o.non_straight_penalty, o.rotation_penalty, o.expansion_ratio, o.reach,
                o.on_approach, *start[:2], motions.offset, motions.scale,
            ]
        )  # fmt: skip
        self._low, high = motions.extent(costs.shape, start)
        self._width = int(high[0] - self._low[0] + 1)
        height = int(high[1] - self._low[1] + 1)
        self._slots = np.zeros(self._width * height * motions.headings.size, dtype=np.int32)
        self._nodes = np.array([[0, 0, motions.first]], dtype=np.int32)
        self._values, self._parents = np.zeros(1, dtype=np.float32), np.full(1, -1, dtype=np.int32)
        self._by, self._closed = np.full(1, -1, dtype=np.int32), np.zeros(1, dtype=np.bool_)
        self._keys, self._items = np.zeros(1, dtype=np.float32), np.zeros(1, dtype=np.int32)
        self._state = np.array([1, 1, -1, 0, 0, -1, -1], dtype=np.int64)
        self._curve = np.zeros((2, 5))
        self._slots[((-self._low[1]) * self._width - self._low[0]) * motions.headings.size + motions.first] = 1

    def advance(self, count: int) -> int:
        """Expand at most so many poses, and return the state of the search."""
        m = self._motions
        more = count * m.most
        for name in ("_nodes", "_values", "_parents", "_by", "_closed"):
            setattr(self, name, grown(getattr(self, name), int(self._state[_NODES]) + more))
        for name in ("_keys", "_items"):
            setattr(self, name, grown(getattr(self, name), int(self._state[_SIZE]) + more))
        return _advance(
            self._costs, self._price, self._polygon, self._rest, self._factor, self._goals, m.headings, m.begin,
            m.ends, m.lengths, m.first_poses, m.poses, self._numbers, self._options.curve_kind,
            self._options.can_rotate, self._options.coarse, self._options.table, self._slots, self._low, self._width,
            self._nodes, self._values, self._parents, self._by, self._closed, self._keys, self._items, self._state,
            self._curve, count,
        )  # fmt: skip

    def path(self) -> Array:
        """Return the poses (n, 3) of the path, positions in cells, once the search has found one."""
        node = int(self._state[_GOAL])
        way = []
        while node >= 0:
            way.append(node)
            node = int(self._parents[node])
        way.reverse()
        parts = [self._start[None]]
        for before, after in pairwise(way):
            motion = int(self._by[after])
            poses = self._motions.poses_of(motion)[-1 if self._motions.lengths[motion] == 0.0 else 0 :].copy()
            poses[:, :2] += self._motions.place(self._start, self._nodes[before, :2])
            poses[-1, :2] = self._motions.place(self._start, self._nodes[after, :2])
            parts.append(poses)
        path = np.concatenate(parts)
        if self._state[_CURVE_TO] >= 0:
            goal = self._goals[self._state[_CURVE_TO]]
            if self._options.is_holonomic:
                curve = straight_poses(path[-1, 0], path[-1, 1], path[-1, 2], goal, self._options.radius)
            else:
                x, y, yaw = path[-1].tolist()
                curve = sampled(self._curve[0], self._curve[1], self._options.radius, x, y, yaw, SPACING)
            path = np.concatenate([path, curve])
        return path


@compiled
def _advance(
    costs: Costs,
    price: Prices,
    polygon: Array,
    rest: Prices,
    factor: int,
    goals: Array,
    headings: Array,
    begin: NDArray[np.int64],
    ends: NDArray[np.int32],
    lengths: Array,
    first_poses: NDArray[np.int64],
    poses: Array,
    numbers: Array,
    curve_kind: int,
    can_rotate: bool,
    coarse: int,
    table: Prices,
    slots: NDArray[np.int32],
    low: NDArray[np.int64],
    lattice_width: int,
    at: NDArray[np.int32],
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
    height, width = costs.shape
    reach = numbers[_REACH]
    rotation = numbers[_ROTATION] if can_rotate else np.inf
    goal_x, goal_y = goals[0, 0], goals[0, 1]
    cosine, sine = numbers[_SCALE] * math.cos(numbers[_START_YAW]), numbers[_SCALE] * math.sin(numbers[_START_YAW])
    size, nodes, nearest = state[_SIZE], state[_NODES], state[_NEAREST]
    closest = reach
    if nearest >= 0:
        x, y = _place(at[nearest, 0], at[nearest, 1], numbers, cosine, sine)
        closest = math.hypot(x - goal_x, y - goal_y)
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
        x, y = _place(at[node, 0], at[node, 1], numbers, cosine, sine)
        heading = at[node, 2]
        yaw = headings[heading]
        apart = math.hypot(x - goal_x, y - goal_y)
        if apart <= 0.5 * math.sqrt(2.0) * numbers[_SCALE] and _looks_along(headings, heading, goals):
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
            if apart <= numbers[_LENGTH]:
                one = reached_goal(costs, price, polygon, x, y, yaw, goals, numbers[:4], curve_kind, coarse, curve)
                if one >= 0:
                    nearest = node
                    state[_CURVE_TO] = one
                    found = FOUND
                    break
        for motion in range(begin[heading], begin[heading + 1]):
            column, row = at[node, 0] + ends[motion, _END_COLUMN], at[node, 1] + ends[motion, _END_ROW]
            there_x, there_y = _place(column, row, numbers, cosine, sine)
            if round(there_x) < 0 or round(there_y) < 0 or round(there_x) >= width or round(there_y) >= height:
                continue
            there = ends[motion, _END_HEADING]
            slot = ((row - low[1]) * lattice_width + column - low[0]) * headings.size + there
            known = slots[slot] - 1
            if known >= 0 and closed[known]:
                continue
            least = values[node] + lengths[motion] * (1.0 - numbers[_RETROSPECTIVE])
            if known >= 0 and least >= values[known]:
                continue
            mean = _mean_price(costs, price, polygon, x, y, yaw, poses[first_poses[motion] : first_poses[motion + 1]])
            if mean == np.inf:
                continue
            value = values[node] + _step_cost(motion, by[node], mean, ends, lengths, numbers)
            if known >= 0 and value >= values[known]:
                continue
            if known < 0:
                known = nodes
                nodes += 1
                slots[slot] = known + 1
                closed[known] = False
            at[known, 0], at[known, 1], at[known, 2] = column, row, there
            values[known], parents[known], by[known] = value, node, motion
            ahead = cost_to_nearest(
                rest, factor, table, there_x, there_y, headings[there], goals, numbers[_RADIUS], curve_kind, rotation
            )
            size = push(keys, items, size, value + ahead, known)
    state[_SIZE], state[_NODES], state[_NEAREST] = size, nodes, nearest
    if found == FOUND:
        state[_GOAL] = nearest
    return found


@compiled
def _place(column: int, row: int, numbers: Array, cosine: float, sine: float) -> tuple[float, float]:
    """Return the position of a node in cells of the costmap."""
    return (
        numbers[_START_X] + cosine * column - sine * row,
        numbers[_START_Y] + sine * column + cosine * row,
    )


@compiled
def _looks_along(headings: Array, heading: int, goals: Array) -> bool:
    """Return whether no other heading is nearer to that of one of the goals."""
    for i in range(goals.shape[0]):
        best = 0
        for k in range(headings.size):
            if abs(remainder(headings[k] - goals[i, 2])) < abs(remainder(headings[best] - goals[i, 2])):
                best = k
        if best == heading:
            return True
    return False


@compiled
def _mean_price(costs: Costs, price: Prices, polygon: Array, x: float, y: float, yaw: float, poses: Array) -> float:
    """Return the mean price under a motion from a pose; infinite where the robot touches something."""
    total = 0.0
    at_x, at_y, at_yaw = x, y, yaw
    for k in range(poses.shape[0]):
        to_x, to_y, to_yaw = x + poses[k, 0], y + poses[k, 1], poses[k, 2]
        if not drives_free(costs, price, polygon, at_x, at_y, at_yaw, to_x, to_y, to_yaw):
            return np.inf
        total += price[costs[round(to_y), round(to_x)]]
        at_x, at_y, at_yaw = to_x, to_y, to_yaw
    return float(total / poses.shape[0])


@compiled
def _step_cost(
    motion: int, before: int, price: float, ends: NDArray[np.int32], lengths: Array, numbers: Array
) -> float:
    """Return the cost of a motion after another one, or after none where that is negative."""
    if lengths[motion] == 0.0:
        return float(numbers[_ROTATION] * price)
    cost = lengths[motion] * (price - numbers[_RETROSPECTIVE])
    side = ends[motion, _SIDE]
    if side != 0:
        is_changed = before >= 0 and ends[before, _SIDE] * side < 0
        cost *= numbers[_TURN] + (numbers[_CHANGE] if is_changed else 0.0)
    if ends[motion, _IS_REVERSE]:
        cost *= numbers[_REVERSE]
    return float(cost)
