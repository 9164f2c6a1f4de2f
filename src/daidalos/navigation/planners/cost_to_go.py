"""Estimates of the cost from each cell to a goal, over larger cells."""

from __future__ import annotations

import math

import numpy as np

from daidalos.common.kernels import compiled
from daidalos.navigation.costmap.costmap import MAX_NON_OBSTACLE, Costs
from daidalos.navigation.planners.search import Prices, pop, push


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
