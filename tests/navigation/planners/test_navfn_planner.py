"""The planner as users meet it: good paths, and good reasons when there is none."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import LETHAL_OBSTACLE, NO_INFORMATION, Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from daidalos.navigation.errors import (
    GoalOccupied,
    GoalOutsideMap,
    NoPath,
    PlannerError,
    StartOccupied,
    StartOutsideMap,
)
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners.navfn_planner import COST_FACTOR, NavfnPlanner, NavfnPlannerParameters
from daidalos.navigation.planners.navigation_function import propagate
from properties import examples

from .worlds import cluttered, random_pose

EXACT = NavfnPlanner(NavfnPlannerParameters(tolerance=0.0))


def pose(x, y, yaw=0.0):
    return np.array([x, y, yaw])


def room(size=4.0, resolution=0.05):
    cells = round(size / resolution)
    return Costmap.filled(cells, cells, resolution, (0.0, 0.0))


def test_a_path_begins_and_ends_where_it_should_and_looks_along():
    path = EXACT.create_plan(room(), pose(0.52, 0.53, 1.0), pose(3.33, 2.21, -2.0))
    assert np.allclose(path[0, :2], [0.52, 0.53])
    assert np.allclose(path[-1], [3.33, 2.21, -2.0])
    ahead = np.diff(path[:, :2], axis=0)
    assert np.allclose(path[:-1, 2], np.arctan2(ahead[:, 1], ahead[:, 0]))
    assert path_length(path) < 1.01 * math.hypot(2.81, 1.68)
    assert np.hypot(ahead[:, 0], ahead[:, 1]).max() < 0.11


def test_the_last_pose_may_look_as_it_arrives():
    planner = NavfnPlanner(NavfnPlannerParameters(use_final_approach_orientation=True))
    path = planner.create_plan(room(), pose(0.5, 2.0), pose(3.5, 2.0, 2.0))
    assert path[-1, 2] == pytest.approx(0.0, abs=0.05)


def test_a_goal_in_the_cell_of_the_robot():
    path = EXACT.create_plan(room(), pose(1.0, 1.0), pose(1.01, 1.01, 0.5))
    assert path.shape[0] >= 1
    assert np.allclose(path[-1], [1.01, 1.01, 0.5])


def steps_over(allow_unknown):
    """Return the cost of a step over a cell of each value, in steps over free space."""
    steps = np.where(np.arange(256) < 253, 1.0 + COST_FACTOR * np.arange(256), np.inf).astype(np.float32)
    steps[NO_INFORMATION] = steps[252] if allow_unknown else np.inf
    return steps


def least_cost(costmap, start, goal, allow_unknown):
    """Return the cost of the best path: the value of the navigation function over the whole map."""
    first, last = (costmap.world_to_map(*one[:2]) for one in (start, goal))
    return propagate(costmap.costs, steps_over(allow_unknown), *first, *last, math.inf)[last[1], last[0]]


def cost_of(costmap, path, allow_unknown):
    """Return the cost of a path, in steps over free space."""
    cells = (path[:, :2] - costmap.origin) / costmap.resolution - 0.5
    dense = np.concatenate([a + (b - a) * np.linspace(0.0, 1.0, 20)[:, None] for a, b in pairwise(cells)] or [cells])
    under = costmap.costs[np.round(dense[:, 1]).astype(int), np.round(dense[:, 0]).astype(int)]
    travelled = np.hypot(*np.diff(dense, axis=0).T)
    return float((travelled * steps_over(allow_unknown)[under[1:]]).sum())


@examples(25)
@given(seed=st.integers(0, 10_000), allow_unknown=st.booleans())
def test_dijkstra_and_a_star_find_ways_of_the_least_cost(seed, allow_unknown):
    costmap, generator = cluttered(seed)
    start, goal = (random_pose(costmap, generator) for _ in range(2))
    paths = []
    for use_astar in (False, True):
        planner = NavfnPlanner(NavfnPlannerParameters(0.0, use_astar, allow_unknown))
        try:
            paths.append(planner.create_plan(costmap, start, goal))
        except NoPath:
            paths.append(None)
    assert (paths[0] is None) == (paths[1] is None)
    for path in paths:
        if path is not None:
            least = least_cost(costmap, start, goal, allow_unknown)
            # First-order differences give values up to a tenth too high; the ends lie anywhere in their cells.
            assert least / 1.1 - 6.0 <= cost_of(costmap, path, allow_unknown) <= 1.05 * least + 6.0


@pytest.mark.parametrize(
    ("start", "goal", "error", "words"),
    [
        (pose(-1.0, 1.0), pose(1.0, 1.0), StartOutsideMap, r"robot at \(-1.00, 1.00\) is outside .* x 0.00 to 4.00"),
        (pose(1.0, 1.0), pose(9.0, 1.0), GoalOutsideMap, r"goal \(9.00, 1.00\) is outside .* y 0.00 to 4.00"),
        (pose(1.0, 1.0), pose(math.nan, 1.0), GoalOutsideMap, "nan"),
        (pose(1.0, 1.0), pose(2.02, 2.02), GoalOccupied, r"goal \(2.02, 2.02\) is in an obstacle"),
    ],
)
def test_bad_poses_are_refused_with_words(start, goal, error, words):
    costmap = room()
    column, row = costmap.world_to_map(2.02, 2.02)
    costmap.costs[row, column] = 254
    with pytest.raises(error, match=words):
        NavfnPlanner().create_plan(costmap, start, goal)


def test_error_codes_are_those_of_the_action():
    codes = [e.code for e in (StartOutsideMap, GoalOutsideMap, StartOccupied, GoalOccupied, NoPath)]
    assert codes == ["START_OUTSIDE_MAP", "GOAL_OUTSIDE_MAP", "START_OCCUPIED", "GOAL_OCCUPIED", "NO_VALID_PATH"]
    assert all(issubclass(e, PlannerError) for e in (StartOutsideMap, GoalOccupied, NoPath))


def test_a_goal_behind_a_wall_has_no_path():
    costmap = room()
    costmap.costs[:, 40] = 254
    with pytest.raises(NoPath, match=r"cut it off and nothing within 0\.5 m"):
        NavfnPlanner().create_plan(costmap, pose(1.0, 1.0), pose(3.5, 1.0))


def test_a_goal_too_near_to_a_wall_is_replaced_within_the_tolerance():
    costmap = room()
    costmap.costs[:, 60:] = 253
    goal = pose(3.2, 2.0, 1.0)
    path = NavfnPlanner().create_plan(costmap, pose(1.0, 2.0), goal)
    assert math.hypot(*(path[-1, :2] - goal[:2])) < 0.3
    assert costmap.cost_at(*path[-1, :2]) == 0
    assert path[-1, 2] == 1.0
    with pytest.raises(GoalOccupied, match="does not fit"):
        EXACT.create_plan(costmap, pose(1.0, 2.0), goal)


def test_a_goal_within_a_wall_of_which_only_the_surface_was_seen_is_refused():
    costmap = room()
    costmap.costs[:, 41:] = NO_INFORMATION
    costmap.costs[:, 40] = LETHAL_OBSTACLE
    with pytest.raises(GoalOccupied, match="in an obstacle"):
        NavfnPlanner().create_plan(costmap, pose(1.0, 1.0), pose(2.09, 1.0))


def test_a_start_inside_of_inflation_gets_out_by_the_shortest_way():
    costmap = room()
    costmap.costs[:, :8] = 253
    costmap.costs[:, 0] = 254
    path = EXACT.create_plan(costmap, pose(0.12, 2.0), pose(3.0, 3.0))
    assert np.allclose(path[0, :2], [0.12, 2.0])
    inside = [costmap.cost_at(*p[:2]) >= 253 for p in path]
    assert inside[0]
    assert not any(inside[2:])
    assert abs(path[1, 1] - 2.0) < 0.06


def test_a_start_in_an_obstacle_that_ends_nearby():
    costmap = room()
    costmap.costs[38:43, 38:43] = 254
    path = EXACT.create_plan(costmap, pose(2.02, 2.02), pose(3.5, 2.0))
    assert np.allclose(path[0, :2], [2.02, 2.02])
    costmap.costs[20:60, 20:60] = 254
    with pytest.raises(StartOccupied, match="enclosed"):
        EXACT.create_plan(costmap, pose(2.02, 2.02), pose(3.5, 2.0))


def test_unknown_ground_is_dear_and_may_be_forbidden():
    costmap = room()
    costmap.costs[30:50, 30:50] = 255
    start, goal = pose(1.0, 2.02), pose(3.0, 2.02)
    path = EXACT.create_plan(costmap, start, goal)
    assert all(costmap.cost_at(*p[:2]) != 255 for p in path)
    costmap.costs[:, 30:50] = 255
    assert any(costmap.cost_at(*p[:2]) == 255 for p in EXACT.create_plan(costmap, start, goal))
    forbidding = NavfnPlanner(NavfnPlannerParameters(tolerance=0.0, allow_unknown=False))
    with pytest.raises(NoPath):
        forbidding.create_plan(costmap, start, goal)
    with pytest.raises(GoalOccupied, match="unknown"):
        forbidding.create_plan(costmap, start, pose(2.0, 2.0))


def test_a_costmap_of_one_cell():
    costmap = Costmap.filled(1, 1, 1.0, (0.0, 0.0))
    path = EXACT.create_plan(costmap, pose(0.2, 0.2), pose(0.8, 0.8, 1.0))
    assert np.allclose(path[-1], [0.8, 0.8, 1.0])
    with pytest.raises(GoalOutsideMap):
        EXACT.create_plan(costmap, pose(0.2, 0.2), pose(1.8, 0.8))


def test_paths_go_through_the_middle_of_doors():
    costmap, _ = cluttered(0, 80, 80, boxes=0, inflated=False)
    costmap.costs[:, 40] = 254
    costmap.costs[32:48, 40] = 0
    InflationLayer(
        InflationLayerParameters(0.55, 3.0), NavigationContext(footprint=Footprint.circle(0.22))
    ).update_costs(costmap, costmap.window)
    path = EXACT.create_plan(costmap, pose(0.0, 3.0), pose(2.5, 5.5))
    door_x, door_y = costmap.map_to_world(40, 39)
    crossing = path[np.argmin(np.abs(path[:, 0] - door_x)), 1]
    assert abs(crossing - door_y) < 0.1
