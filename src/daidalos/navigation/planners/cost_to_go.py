"""Estimates of the cost from each cell to a goal, over larger cells."""

from __future__ import annotations

import math

import numpy as np

from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import MAX_NON_OBSTACLE, Costmap, Costs
from daidalos.navigation.planners.search import Prices, pop, push
from daidalos.navigation.planners.terminals import Cell


class CostsToGoal:
    """Costs to goals over cells as large as those of the costmap or twice as large, kept for the next plan or not.

    Parameters
    ----------
    is_kept : bool
        Whether the costs to a goal serve the next plan to it too, though the costmap may have changed.
    is_downsampled : bool
        Whether the cells are twice as large.
    """

    def __init__(self, *, is_kept: bool, is_downsampled: bool) -> None:
        self._is_kept = is_kept
        self.factor = 2 if is_downsampled else 1
        self._last: tuple[object, Prices] | None = None

    def compute(
        self, costmap: Costmap, price: Prices, first: Cell, last: Cell, *, reach: float, margin: float
    ) -> Prices:
        """Return the costs of `costs_to_goal` in cells of the costmap, from the cell `first` to the cell `last`."""
        key = (last, costmap.costs.shape, tuple(costmap.origin), price.tobytes(), reach)
        if self._is_kept and self._last is not None and self._last[0] == key:
            return self._last[1]
        factor = self.factor
        costs = cheapest_costs(costmap.costs, price, factor) if factor > 1 else costmap.costs
        rest: Prices = factor * costs_to_goal(
            costs, price, last[0] // factor, last[1] // factor, reach / factor, np.inf if self._is_kept else margin,
            first[0] // factor, first[1] // factor,
        )  # fmt: skip
        self._last = key, rest
        return rest


@compiled
def cheapest_costs(costs: Costs, price: Prices, factor: int) -> Costs:
    """Return costs of cells `factor` times as large, each the one of the lowest price in it."""
    height, width = costs.shape
    found = np.empty((-(-height // factor), -(-width // factor)), dtype=np.uint8)
    for row in range(found.shape[0]):
        for column in range(found.shape[1]):
            best = costs[row * factor, column * factor]
            for y in range(row * factor, min((row + 1) * factor, height)):
                for x in range(column * factor, min((column + 1) * factor, width)):
                    if price[costs[y, x]] < price[best]:
                        best = costs[y, x]
            found[row, column] = best
    return found


@compiled
def costs_to_goal(costs: Costs, price: Prices, goal_column: int, goal_row: int, reach: float, margin: float,
                  start_column: int, start_row: int) -> Prices:  # fmt: skip
    """Return the cost of the best way from each cell to the goal, over cells and their eight neighbours.

    Parameters
    ----------
    costs : ndarray of uint8, shape (height, width)
    price : ndarray of float32, shape (256,)
    goal_column, goal_row, start_column, start_row : int
    reach : float
        Distance [cells] from the goal within which obstacles count as passable, as another goal may take its place.
    margin : float
        How much farther than the start's cost is computed; cells beyond have the last cost. Infinite for all cells.

    Returns
    -------
    ndarray of float32, shape (height, width)
        Infinite everywhere if the start cannot be reached.
    """
    height, width = costs.shape
    value = np.full((height, width), np.inf, dtype=np.float32)
    keys = np.empty(8 * costs.size + 1, dtype=np.float32)
    items = np.empty(8 * costs.size + 1, dtype=np.int32)
    value[goal_row, goal_column] = 0.0
    size = push(keys, items, 0, 0.0, goal_row * width + goal_column)
    last = np.float32(0.0)
    while size > 0:
        last, cell = keys[0], items[0]
        size = pop(keys, items, size)
        row = cell // width
        column = cell - row * width
        if last > value[row, column]:
            continue
        if last > 1.3 * value[start_row, start_column] + margin:
            break
        here = price[costs[row, column]]
        if here == np.inf:
            here = price[MAX_NON_OBSTACLE]
        for y in range(max(row - 1, 0), min(row + 2, height)):
            for x in range(max(column - 1, 0), min(column + 2, width)):
                one = price[costs[y, x]]
                if one == np.inf:
                    if (x - goal_column) ** 2 + (y - goal_row) ** 2 > reach * reach:
                        continue
                    one = price[MAX_NON_OBSTACLE]
                length = math.sqrt(2.0) if x != column and y != row else 1.0
                better = np.float32(last + 0.5 * length * (here + one))
                if better < value[y, x]:
                    value[y, x] = better
                    size = push(keys, items, size, float(better), y * width + x)
    if value[start_row, start_column] < np.inf:
        for row in range(height):
            for column in range(width):
                value[row, column] = min(value[row, column], last)
    return value
