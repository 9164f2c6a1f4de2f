"""Theta*: lengths against a visibility graph, and each parameter."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse.csgraph import dijkstra

from daidalos.navigation.errors import GoalOccupied, NoPath, PlanningCancelled
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners.grid_search import line_price
from daidalos.navigation.planners.search import prices
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner, ThetaStarPlannerParameters
from properties import examples

from .common import is_free, pose, refuses_bad_poses, room
from .worlds import cluttered, random_pose

PRICE = prices(1.0, 0.0, quadratic=True, allow_unknown=True)


def planner(**parameters):
    return ThetaStarPlanner(ThetaStarPlannerParameters(**parameters))


def shortest(costmap, start, goal):
    """Return the length [cells] of the shortest path over the centres of cells at the corners of obstacles."""
    blocked = np.pad(costmap.costs >= 253, 1, constant_values=True)
    corners = {start, goal}
    for row, column in np.argwhere(~blocked[1:-1, 1:-1]):
        for dx, dy in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            sides = blocked[row + 1, column + 1 + dx] or blocked[row + 1 + dy, column + 1]
            if blocked[row + 1 + dy, column + 1 + dx] and not sides:
                corners.add((int(column), int(row)))
    points = np.array(sorted(corners), dtype=float)
    graph = np.array([[line_price(costmap.costs, PRICE, *a, *b) for b in points] for a in points])
    graph[np.isinf(graph)] = 0.0
    order = sorted(corners)
    return dijkstra(graph, indices=order.index(start))[order.index(goal)]


@examples(20)
@given(seed=st.integers(0, 10_000))
def test_lengths_are_those_of_a_visibility_graph(seed):
    costmap, generator = cluttered(seed, inflated=False)
    cells = [costmap.world_to_map(*random_pose(costmap, generator)[:2]) for _ in range(2)]
    start, goal = (np.array([*costmap.map_to_world(*cell), 0.0]) for cell in cells)
    least = shortest(costmap, *cells) * costmap.resolution
    if math.isinf(least):
        with pytest.raises(NoPath):
            planner().create_plan(costmap, start, goal)
        return
    path = planner().create_plan(costmap, start, goal)
    assert path_length(path) <= 1.01 * least + 1e-9
    assert is_free(costmap, path)  # between centres of cells there may be shorter ways


@examples(20)
@given(seed=st.integers(0, 10_000), corners=st.sampled_from([4, 8]))
def test_paths_over_inflated_maps_touch_nothing(seed, corners):
    costmap, generator = cluttered(seed)
    start, goal = (random_pose(costmap, generator) for _ in range(2))
    try:
        path = planner(how_many_corners=corners).create_plan(costmap, start, goal)
    except NoPath:
        return
    assert is_free(costmap, path)
    assert np.allclose(path[0, :2], start[:2])
    assert np.allclose(path[-1], goal)
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max(initial=0.0) <= costmap.resolution + 1e-9


@examples(40)
@given(points=st.lists(st.floats(0.0, 19.0), min_size=4, max_size=4), seed=st.integers(0, 100))
def test_the_price_of_a_line_is_its_integral(points, seed):
    costs = np.random.default_rng(seed).integers(0, 253, (20, 20)).astype(np.uint8)
    price = prices(1.0, 2.0, quadratic=True, allow_unknown=True)
    x0, y0, x1, y1 = points
    share = (np.arange(20_000) + 0.5) / 20_000
    columns = np.floor(x0 + share * (x1 - x0) + 0.5).astype(int)
    rows = np.floor(y0 + share * (y1 - y0) + 0.5).astype(int)
    expected = price[costs[rows, columns]].astype(float).mean() * math.hypot(x1 - x0, y1 - y0)
    assert line_price(costs, price, x0, y0, x1, y1) == pytest.approx(expected, rel=3e-3, abs=3e-3)


def test_errors():
    refuses_bad_poses(planner)


def test_weights_choose_between_a_short_and_a_cheap_path():
    costmap = room()
    costmap.costs[20:60, 30:50] = 150
    start, goal = pose(0.5, 2.0), pose(3.5, 2.0)
    straight = planner(w_traversal_cost=0.0).create_plan(costmap, start, goal)
    around = planner(w_traversal_cost=20.0).create_plan(costmap, start, goal)
    assert path_length(straight) == pytest.approx(3.0, abs=0.01)
    assert max(costmap.cost_at(*one[:2]) for one in around) == 0
    assert path_length(planner(w_traversal_cost=20.0, w_euc_cost=100.0).create_plan(costmap, start, goal)) < 3.01


def test_unknown_cells_and_the_final_heading():
    costmap = room()
    costmap.costs[:, 40] = 255
    start, goal = pose(1.0, 1.0), pose(3.0, 1.0, 2.0)
    assert planner().create_plan(costmap, start, goal)[-1, 2] == 2.0
    assert planner(use_final_approach_orientation=True).create_plan(costmap, start, goal)[-1, 2] == pytest.approx(0.0)
    with pytest.raises(NoPath):
        planner(allow_unknown=False).create_plan(costmap, start, goal)
    with pytest.raises(GoalOccupied):
        planner(allow_unknown=False).create_plan(costmap, start, pose(2.02, 1.0))


def test_a_search_that_is_no_longer_wanted_ends_at_the_next_look():
    looks = []
    asked = planner(terminal_checking_interval=50)
    asked.is_cancelled = lambda: bool(looks.append(None)) or len(looks) == 3
    costmap = room()
    costmap.costs[:, 70] = 254
    with pytest.raises(PlanningCancelled):
        asked.create_plan(costmap, pose(0.5, 0.5), pose(3.8, 1.0))
    assert len(looks) == 3
