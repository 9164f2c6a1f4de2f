"""Smac 2D: paths that touch nothing, and each parameter."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.errors import GoalOccupied, NoPath, PlanningTimedOut
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners.smac_parameters import PathSmoothing
from daidalos.navigation.planners.smac_planner_2d import SmacPlanner2D, SmacPlanner2DParameters
from properties import examples

from .common import is_free, pose, refuses_bad_poses, room
from .worlds import cluttered, random_pose


def planner(**parameters):
    return SmacPlanner2D(SmacPlanner2DParameters(**parameters))


@examples(20)
@given(seed=st.integers(0, 10_000), factor=st.integers(1, 2))
def test_paths_touch_nothing(seed, factor):
    costmap, generator = cluttered(seed)
    start, goal = (random_pose(costmap, generator) for _ in range(2))
    asked = planner(tolerance=0.0, downsample_costmap=factor > 1, downsampling_factor=factor)
    try:
        path = asked.create_plan(costmap, start, goal)
    except (NoPath, GoalOccupied):
        return
    assert is_free(costmap, path) or factor > 1
    assert np.allclose(path[0, :2], start[:2])
    assert np.allclose(path[-1], goal)


def test_errors():
    refuses_bad_poses(lambda: planner(tolerance=0.0))


def test_a_goal_that_is_occupied_or_cut_off_is_replaced_within_the_tolerance():
    costmap = room()
    costmap.costs[:, 40:60] = 254
    for goal in (pose(2.3, 1.0), pose(3.02, 1.0)):
        path = planner(tolerance=1.2).create_plan(costmap, pose(1.0, 1.0), goal)
        assert path[-1, 0] == pytest.approx(1.975)
        assert is_free(costmap, path)
    with pytest.raises(GoalOccupied):
        planner(tolerance=0.125).create_plan(costmap, pose(1.0, 1.0), pose(2.4, 1.0))


def test_the_approach_ends_after_its_iterations():
    costmap = room()
    costmap.costs[:, 40:] = 254
    ends = [
        planner(tolerance=1.2, max_on_approach_iterations=count).create_plan(costmap, pose(0.3, 1.0), pose(2.4, 1.0))[
            -1
        ]
        for count in (0, 1000)
    ]
    assert ends[0][0] < ends[1][0] - 0.3


def test_a_search_ends_after_its_iterations_and_its_time():
    costmap = room()
    start, goal = pose(0.5, 0.5), pose(3.5, 3.1)
    with pytest.raises(NoPath, match="max_iterations, 20"):
        planner(max_iterations=20).create_plan(costmap, start, goal)
    assert len(planner(max_iterations=0, max_planning_time=0.0).create_plan(costmap, start, goal)) > 10
    with pytest.raises(PlanningTimedOut, match="max_planning_time") as caught:
        planner(max_planning_time=1e-9, terminal_checking_interval=1).create_plan(costmap, start, goal)
    assert caught.value.code == "TIMEOUT"


def test_the_weight_of_costs_unknown_cells_and_the_final_heading():
    costmap = room()
    costmap.costs[20:60, 30:50] = 150
    start, goal = pose(0.5, 2.0), pose(3.5, 2.0, 2.0)
    rough = PathSmoothing(w_smooth=0.0)
    paths = [planner(cost_travel_multiplier=m, smoother=rough).create_plan(costmap, start, goal) for m in (0.0, 10.0)]
    assert [max(costmap.cost_at(*one[:2]) for one in path) for path in paths] == [150, 0]
    assert planner().create_plan(costmap, start, goal)[-1, 2] == 2.0
    arriving = planner(cost_travel_multiplier=0.0, use_final_approach_orientation=True)
    assert arriving.create_plan(costmap, start, goal)[-1, 2] == pytest.approx(0.0, abs=0.8)
    costmap.costs[:, 40] = 255
    with pytest.raises(NoPath):
        planner(allow_unknown=False).create_plan(costmap, start, goal)


def test_smoothing_shortens_the_path():
    start, goal = pose(0.525, 0.525), pose(3.5, 1.6)
    rough, once, thrice = (
        planner(smoother=PathSmoothing(**given)).create_plan(room(), start, goal)
        for given in ({"w_smooth": 0.0}, {"do_refinement": False, "max_iterations": 3}, {"refinement_num": 2})
    )
    assert path_length(rough) > path_length(once) > path_length(thrice) >= math.hypot(2.975, 1.075) - 1e-9
