"""The wavefront against closed forms and against Dijkstra's algorithm of scipy."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from daidalos.navigation.planners.navfn_planner import COST_FACTOR
from daidalos.navigation.planners.navigation_function import descend, nearest_passable_cell, nearest_reached, propagate
from properties import examples

from .worlds import cluttered

STEP = np.where(np.arange(256) < 253, 1.0 + COST_FACTOR * np.arange(256), np.inf).astype(np.float32)
AXES = [(-1, 0), (1, 0), (0, -1), (0, 1)]


def graph_costs(costs, start):
    """Cost of the best way along the axes, from cell to cell, by scipy; a move costs what its end does."""
    height, width = costs.shape
    cells = np.arange(height * width).reshape(height, width)
    rows, columns, prices = [], [], []
    for dx, dy in AXES:
        here = (slice(max(-dy, 0), height - max(dy, 0)), slice(max(-dx, 0), width - max(dx, 0)))
        there = (slice(max(dy, 0), height - max(-dy, 0)), slice(max(dx, 0), width - max(-dx, 0)))
        passable = np.isfinite(STEP[costs[there]])
        rows.append(cells[here][passable])
        columns.append(cells[there][passable])
        prices.append(STEP[costs[there]][passable])
    size = height * width
    graph = coo_matrix((np.concatenate(prices), (np.concatenate(rows), np.concatenate(columns))), (size, size))
    return dijkstra(graph.tocsr(), indices=start[1] * width + start[0]).reshape(height, width)


def sweep(costs, start):
    """The twin: sweeps over all cells, in four orders, until nothing changes (Zhao 2005)."""
    height, width = costs.shape
    value = np.full((height + 2, width + 2), np.inf)
    value[start[1] + 1, start[0] + 1] = 0.0
    price = STEP[costs].astype(float)
    for number in range(200):
        before = value.copy()
        rows = range(height) if number & 1 else range(height - 1, -1, -1)
        columns = range(width) if number & 2 else range(width - 1, -1, -1)
        for row in rows:
            for column in columns:
                a = min(value[row + 1, column], value[row + 1, column + 2])
                b = min(value[row, column + 1], value[row + 2, column + 1])
                h = price[row, column]
                if not np.isfinite(h) or not np.isfinite(min(a, b)):
                    continue
                one_sided = abs(a - b) >= h
                best = min(a, b) + h if one_sided else 0.5 * (a + b + math.sqrt(2.0 * h * h - (a - b) ** 2))
                value[row + 1, column + 1] = min(value[row + 1, column + 1], best)
        if number > 4 and np.array_equal(before, value):
            break
    return value[1:-1, 1:-1]


def test_on_free_ground_the_value_is_the_distance():
    costs = np.zeros((101, 101), dtype=np.uint8)
    value = propagate(costs, STEP, 50, 50, 0, 0, np.inf)
    y, x = np.mgrid[-50:51, -50:51]
    distance = np.hypot(x, y)
    far = distance > 20
    # First-order differences are too long by at most a tenth near the start, and by little farther off.
    assert (value >= distance - 1e-3).all()
    assert (value[far] / distance[far]).max() < 1.05
    assert np.allclose(value[50], np.abs(np.arange(-50, 51)), atol=1e-3)


def test_over_dear_ground_the_value_grows_as_fast_as_the_cost():
    costs = np.full((5, 60), 100, dtype=np.uint8)
    value = propagate(costs, STEP, 0, 2, 59, 2, np.inf)
    assert value[2, 59] == pytest.approx(59 * STEP[100], rel=1e-4)


@examples(12)
@given(seed=st.integers(0, 10_000))
def test_values_are_those_of_plain_sweeps(seed):
    costmap, generator = cluttered(seed, 25, 30, boxes=4)
    rows, columns = np.nonzero(costmap.costs < 253)
    i = generator.integers(rows.size)
    # An obstacle as goal is never reached, so the front goes everywhere.
    value = propagate(costmap.costs, STEP, columns[i], rows[i], 0, 0, np.inf)
    assert np.allclose(value, sweep(costmap.costs, (columns[i], rows[i])), rtol=2e-3, atol=1e-2)


@examples(25)
@given(seed=st.integers(0, 10_000))
def test_values_lie_between_the_bounds_of_ways_along_the_axes(seed):
    costmap, generator = cluttered(seed)
    rows, columns = np.nonzero(costmap.costs < 253)
    i, j = generator.integers(rows.size, size=2)
    start, goal = (columns[i], rows[i]), (columns[j], rows[j])
    value = propagate(costmap.costs, STEP, *start, *goal, np.inf)[goal[1], goal[0]]
    along_axes = graph_costs(costmap.costs, start)[goal[1], goal[0]]
    assert np.isfinite(value) == np.isfinite(along_axes)
    if np.isfinite(value):
        assert along_axes / math.sqrt(2.0) * 0.999 <= value <= along_axes * 1.001


@examples(25)
@given(seed=st.integers(0, 10_000))
def test_a_bound_that_is_not_too_low_changes_nothing_at_the_goal(seed):
    costmap, generator = cluttered(seed)
    rows, columns = np.nonzero(costmap.costs < 253)
    i, j = generator.integers(rows.size, size=2)
    cells = (columns[i], rows[i], columns[j], rows[j])
    whole = propagate(costmap.costs, STEP, *cells, np.inf)
    value = whole[rows[j], columns[j]]
    if np.isfinite(value):
        bounded = propagate(costmap.costs, STEP, *cells, 1.3 * value + 5.0)
        assert bounded[rows[j], columns[j]] == pytest.approx(value, rel=1e-3)
        assert np.isfinite(bounded).sum() <= np.isfinite(whole).sum() or not np.isfinite(whole).all()


@examples(40)
@given(seed=st.integers(0, 10_000))
def test_the_way_down_costs_what_the_value_says(seed):
    costmap, generator = cluttered(seed)
    rows, columns = np.nonzero(costmap.costs < 253)
    i, j = generator.integers(rows.size, size=2)
    start, goal = (columns[i], rows[i]), (columns[j], rows[j])
    value = propagate(costmap.costs, STEP, *start, *goal, np.inf)
    if not np.isfinite(value[goal[1], goal[0]]):
        return
    way = descend(value, goal[0], goal[1], start[0], start[1])
    assert way[0].tolist() == list(start)
    assert way[-1].tolist() == list(goal)
    steps = np.hypot(*np.diff(way, axis=0).T)
    assert steps.max(initial=0.0) < 1.6
    dense = np.concatenate([a + (b - a) * np.linspace(0.0, 1.0, 20)[:, None] for a, b in pairwise(way)] or [way])
    under = costmap.costs[np.round(dense[:, 1]).astype(int), np.round(dense[:, 0]).astype(int)]
    assert (under < 253).all()
    travelled = np.hypot(*np.diff(dense, axis=0).T)
    price = float((travelled * STEP[under[1:]]).sum())
    assert price <= 1.1 * value[goal[1], goal[0]] + 3.0


def test_a_straight_way_is_straight():
    costs = np.zeros((60, 120), dtype=np.uint8)
    value = propagate(costs, STEP, 5, 10, 110, 50, np.inf)
    way = descend(value, 110, 50, 5, 10)
    length = np.hypot(*np.diff(way, axis=0).T).sum()
    assert length < 1.01 * math.hypot(105, 40)


def test_the_nearest_cell_that_was_reached():
    value = np.full((20, 20), np.inf, dtype=np.float32)
    value[5, 5] = value[5, 12] = 3.0
    assert nearest_reached(value, 7, 5, 4.0) == (5, 5)
    assert nearest_reached(value, 7, 5, 1.9) == (-1, -1)


def test_of_two_cells_equally_near_the_one_that_is_quicker_to_reach():
    value = np.full((9, 9), np.inf, dtype=np.float32)
    value[4, 2], value[4, 6] = 50.0, 10.0
    assert nearest_reached(value, 4, 4, 3.0) == (6, 4)


def test_ways_out_of_inflation_do_not_lead_through_walls():
    costs = np.full((9, 9), 253, dtype=np.uint8)
    costs[:, 4] = 254
    costs[:, 8] = 0
    costs[8, 0] = 0
    # Column 8 is as near as the corner, but behind the wall.
    assert nearest_passable_cell(costs, STEP, 3, 8, 10.0) == (0, 8)
    costs[8, 0] = 253
    assert nearest_passable_cell(costs, STEP, 3, 8, 10.0) == (-1, -1)


def test_a_way_out_of_an_obstacle_is_short_or_none():
    costs = np.full((9, 9), 254, dtype=np.uint8)
    costs[4, 7] = 0
    assert nearest_passable_cell(costs, STEP, 4, 4, 3.0) == (7, 4)
    assert nearest_passable_cell(costs, STEP, 4, 4, 2.0) == (-1, -1)
