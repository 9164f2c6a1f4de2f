"""A* and Theta* over the cells of a costmap, and costs of straight lines over them."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import Costmap, Costs
from daidalos.navigation.planners.search import EXHAUSTED, FOUND, RUNNING, Prices, grown, pop, push

_SIZE, _NEAREST, _ON_APPROACH, _GOAL = range(4)


class GridSearch:
    """Search for a path from cell to cell, in steps that the caller counts.

    A* (Hart, Nilsson and Raphael 1968), or Theta* (Nash, Daniel, Koenig and Felner 2007), where the predecessor of a
    cell may be any that is in sight. The price of a line is the integral of the cells' prices along it.

    Parameters
    ----------
    costmap : Costmap
    price : ndarray of float32, shape (256,)
        Price of a cell's length over a cell of each cost; infinite where the robot cannot be.
    start, goal : tuple of int
        Columns and rows; the start is passable.
    corners : int
        Neighbours of a cell: 4, or 8 with those at its corners.
    is_any_angle : bool
        Whether to search by Theta*.
    reach : float
        Distance [cells] from the goal within which another cell may take its place.
    on_approach : int
        Cells that are expanded from the first one within reach on, before the nearest one takes the goal's place.
    """

    def __init__(
        self,
        costmap: Costmap,
        price: Prices,
        start: tuple[int, int],
        goal: tuple[int, int],
        *,
        corners: int = 8,
        is_any_angle: bool = False,
        reach: float = 0.0,
        on_approach: int = 0,
    ) -> None:
        self._costs, self._price, self._goal = costmap.costs, price, goal
        self._corners, self._is_any_angle, self._reach, self._on_approach = corners, is_any_angle, reach, on_approach
        cells = costmap.costs.size
        first = start[1] * costmap.width + start[0]
        self._value = np.full(cells, np.inf, dtype=np.float32)
        self._before = np.empty(cells, dtype=np.int32)
        self._closed = np.zeros(cells, dtype=np.bool_)
        self._keys, self._items = np.zeros(1, dtype=np.float32), np.full(1, first, dtype=np.int32)
        self._state = np.array([1, -1, 0, -1], dtype=np.int64)
        self._value[first], self._before[first] = 0.0, first

    def advance(self, count: int) -> int:
        """Expand at most so many cells, and return the state of the search."""
        capacity = int(self._state[_SIZE]) + count * self._corners
        self._keys, self._items = grown(self._keys, capacity), grown(self._items, capacity)  # type: ignore[assignment]
        return _advance(
            self._costs, self._price, self._value, self._before, self._closed, self._keys, self._items, self._state,
            self._goal[0], self._goal[1], self._corners, self._is_any_angle, self._reach, self._on_approach, count,
        )  # fmt: skip

    def cells(self) -> NDArray[np.int64]:
        """Return columns and rows of the path (n, 2) from the start; none if the search ended without one."""
        cell = int(self._state[_GOAL])
        way: list[int] = []
        while cell >= 0:
            way.append(cell)
            before = int(self._before[cell])
            cell = before if before != cell else -1
        rows, columns = np.divmod(np.array(way[::-1], dtype=np.int64), self._costs.shape[1])
        return np.stack([columns, rows], axis=-1)


@compiled
def _advance(
    costs: Costs,
    price: Prices,
    value: Prices,
    before: NDArray[np.int32],
    closed: NDArray[np.bool_],
    keys: Prices,
    items: NDArray[np.int32],
    state: NDArray[np.int64],
    goal_column: int,
    goal_row: int,
    corners: int,
    is_any_angle: bool,
    reach: float,
    on_approach: int,
    count: int,
) -> int:
    height, width = costs.shape
    flat = costs.ravel()
    cheapest = price[0]
    goal = goal_row * width + goal_column
    size, nearest, approaching = state[_SIZE], state[_NEAREST], state[_ON_APPROACH]
    closest = reach + 1e-6
    if nearest >= 0:
        closest = math.hypot(nearest % width - goal_column, nearest // width - goal_row)
    done = 0
    found = RUNNING
    while done < count:
        if size == 0:
            found = FOUND if nearest >= 0 else EXHAUSTED
            break
        cell = items[0]
        size = pop(keys, items, size)
        if closed[cell]:
            continue
        closed[cell] = True
        done += 1
        row = cell // width
        column = cell - row * width
        if cell == goal:
            nearest = cell
            found = FOUND
            break
        if reach > 0.0:
            distance = math.hypot(column - goal_column, row - goal_row)
            if distance < closest:
                nearest, closest = cell, distance
            approaching += nearest >= 0
            if approaching > on_approach:
                found = FOUND
                break
        parent = before[cell]
        parent_row = parent // width
        parent_column = parent - parent_row * width
        for y in range(max(row - 1, 0), min(row + 2, height)):
            for x in range(max(column - 1, 0), min(column + 2, width)):
                other = y * width + x
                if closed[other] or price[flat[other]] == np.inf:
                    continue
                is_diagonal = x != column and y != row
                if is_diagonal and (
                    corners == 4 or price[costs[row, x]] == np.inf or price[costs[y, column]] == np.inf
                ):
                    continue
                if is_any_angle:
                    better = value[cell] + line_price(costs, price, column, row, x, y)
                    if parent != cell:
                        straight = value[parent] + line_price(costs, price, parent_column, parent_row, x, y)
                        if straight <= better + 1e-4:
                            if straight < value[other]:
                                value[other], before[other] = straight, parent
                                rest = cheapest * math.hypot(x - goal_column, y - goal_row)
                                size = push(keys, items, size, straight + rest, other)
                            continue
                else:
                    length = math.sqrt(2.0) if is_diagonal else 1.0
                    better = value[cell] + 0.5 * length * (price[flat[cell]] + price[flat[other]])
                if better < value[other]:
                    value[other], before[other] = better, cell
                    rest = cheapest * math.hypot(x - goal_column, y - goal_row)
                    size = push(keys, items, size, better + rest, other)
    state[_SIZE], state[_NEAREST], state[_ON_APPROACH] = size, nearest, approaching
    if found == FOUND:
        state[_GOAL] = nearest
    return found


@compiled
def line_price(costs: Costs, price: Prices, x0: float, y0: float, x1: float, y1: float) -> float:
    """Return the price of the line between two points in cells, whole numbers at centres; infinite if it is blocked.

    The line visits each cell that it crosses (Amanatides and Woo 1987); where it passes through a corner, the cells on
    both sides must be passable.
    """
    height, width = costs.shape
    column, row = math.floor(x0 + 0.5), math.floor(y0 + 0.5)
    last_column, last_row = math.floor(x1 + 0.5), math.floor(y1 + 0.5)
    dx, dy = x1 - x0, y1 - y0
    length = math.hypot(dx, dy)
    step_x = 1 if dx > 0.0 else -1
    step_y = 1 if dy > 0.0 else -1
    per_x = 1.0 / abs(dx) if dx != 0.0 else np.inf
    per_y = 1.0 / abs(dy) if dy != 0.0 else np.inf
    next_x = (column + 0.5 * step_x - x0) * step_x * per_x if dx != 0.0 else np.inf
    next_y = (row + 0.5 * step_y - y0) * step_y * per_y if dy != 0.0 else np.inf
    here = 0.0
    total = 0.0
    for _ in range(abs(last_column - column) + abs(last_row - row) + 1):
        if row < 0 or column < 0 or row >= height or column >= width:
            return np.inf
        one = price[costs[row, column]]
        if one == np.inf:
            return np.inf
        if column == last_column and row == last_row:
            break
        there = min(next_x, next_y)
        total += one * (there - here)
        here = there
        if abs(next_x - next_y) < 1e-9:
            beside = price[costs[row, min(max(column + step_x, 0), width - 1)]]
            above = price[costs[min(max(row + step_y, 0), height - 1), column]]
            if beside == np.inf or above == np.inf:
                return np.inf
            column += step_x
            row += step_y
            next_x += per_x
            next_y += per_y
        elif next_x < next_y:
            column += step_x
            next_x += per_x
        else:
            row += step_y
            next_y += per_y
    return float(length * (total + price[costs[last_row, last_column]] * (1.0 - here)))


@compiled
def tightened(costs: Costs, price: Prices, points: Array) -> Array:
    """Return a path of straight lines with fewer and better corners.

    Corners between two in sight of each other are left out where that is not dearer, and the others move from cell to
    cell as long as the path gets cheaper.

    Parameters
    ----------
    costs : ndarray of uint8, shape (height, width)
    price : ndarray of float32, shape (256,)
    points : ndarray, shape (n, 2)
        In cells, whole numbers at the centres.
    """
    kept = points.copy()
    count = kept.shape[0]
    for _ in range(50):
        changed = False
        i = 1
        while i < count - 1:
            a, b = kept[i - 1], kept[i + 1]
            least = line_price(costs, price, a[0], a[1], kept[i, 0], kept[i, 1])
            least += line_price(costs, price, kept[i, 0], kept[i, 1], b[0], b[1])
            if line_price(costs, price, a[0], a[1], b[0], b[1]) <= least + 1e-9:
                kept[i : count - 1] = kept[i + 1 : count].copy()
                count -= 1
                changed = True
                continue
            x, y = kept[i, 0], kept[i, 1]
            for dx in range(-1, 2):
                for dy in range(-1, 2):
                    there = line_price(costs, price, a[0], a[1], x + dx, y + dy)
                    if there < least:
                        there += line_price(costs, price, x + dx, y + dy, b[0], b[1])
                    if there < least - 1e-6:
                        least = there
                        kept[i, 0], kept[i, 1] = x + dx, y + dy
                        changed = True
            i += 1
        if not changed:
            break
    return kept[:count].copy()


def spaced(points: Array, spacing: float) -> Array:
    """Return the points (n, 2) of straight lines with others between them, at most `spacing` apart."""
    parts: list[Any] = [points[:1]]
    for a, b in pairwise(points):
        count = max(math.ceil(float(np.hypot(*(b - a))) / spacing - 1e-9), 1)
        parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(parts)


def restore_where_blocked(path: Array, given: Array, costmap: Costmap, price: Prices) -> None:
    """Put points of a smoothed path back to their given places where the line to the next one is blocked.

    Parameters
    ----------
    path, given : ndarray, shape (n, 3)
        The smoothed path, which is changed, and the one before.
    costmap : Costmap
    price : ndarray of float32, shape (256,)
    """
    moved = np.ones(path.shape[0], dtype=np.bool_)
    while moved.any():
        cells = (path[:, :2] - costmap.origin) / costmap.resolution - 0.5
        blocked = np.zeros(path.shape[0], dtype=np.bool_)
        for i in range(path.shape[0] - 1):
            if line_price(costmap.costs, price, cells[i, 0], cells[i, 1], *cells[i + 1]) == np.inf:
                blocked[i : i + 2] = True
        blocked &= moved
        if not blocked.any():
            return
        path[blocked] = given[blocked]
        moved &= ~blocked
