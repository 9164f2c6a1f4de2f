"""Hybrid-A*: paths that the robot can drive and that touch nothing, and each parameter."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.errors import GoalOccupied, NoPath, PlannerError, PlanningCancelled, PlanningTimedOut
from daidalos.navigation.paths import path_length, split_at_cusps
from daidalos.navigation.planners.cost_to_go import costs_to_goal
from daidalos.navigation.planners.curves import shortest_curve
from daidalos.navigation.planners.smac_parameters import PathSmoothing
from daidalos.navigation.planners.smac_planner_hybrid import SmacPlannerHybrid, SmacPlannerHybridParameters
from properties import examples

from .common import is_free, pose, refuses_bad_poses, room
from .worlds import cluttered, random_pose

OUTLINE = Footprint.of_corners(np.array([[0.25, 0.1], [0.25, -0.1], [-0.1, -0.1], [-0.1, 0.1]]))
BOTH = "REEDS_SHEPP"


def planner(footprint=None, **parameters):
    parameters.setdefault("lookup_table_size", 3.0)
    context = None if footprint is None else NavigationContext(footprint=footprint)
    return SmacPlannerHybrid(SmacPlannerHybridParameters(**parameters), context)


def curvatures(path):
    """Return the curvature [1/m] of the circle through each pose and its neighbours, cusps left out."""
    found = []
    for part in split_at_cusps(path):
        steps = np.diff(part[:, :2], axis=0)
        a, b = steps[:-1], steps[1:]
        lengths = np.hypot(*a.T) * np.hypot(*b.T) * np.hypot(*(a + b).T)
        found += (2.0 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / lengths).tolist()
    return found


def backwards(path):
    """Return the length [m] that is driven backwards."""
    steps = np.diff(path[:, :2], axis=0)
    ahead = steps[:, 0] * np.cos(path[:-1, 2]) + steps[:, 1] * np.sin(path[:-1, 2])
    return float(-ahead[ahead < -1e-3].sum())


@examples(25)
@given(
    seed=st.integers(0, 10_000),
    model=st.sampled_from(["DUBIN", BOTH]),
    is_round=st.booleans(),
    radius=st.sampled_from([0.2, 0.4, 0.7]),
    mode=st.sampled_from(["DEFAULT", "BIDIRECTIONAL", "ALL_DIRECTION"]),
)
def test_paths_can_be_driven_and_touch_nothing(seed, model, is_round, radius, mode):
    costmap, generator = cluttered(seed, boxes=5)
    start, goal = (random_pose(costmap, generator) for _ in range(2))
    asked = planner(
        None if is_round else OUTLINE, motion_model_for_search=model, minimum_turning_radius=radius,
        goal_heading_mode=mode, coarse_search_resolution=6,
    )  # fmt: skip
    try:
        path = asked.create_plan(costmap, start, goal)
    except PlannerError:
        return
    checker = FootprintCollisionChecker(costmap, asked.context.footprint)
    assert not any(checker.in_collision(one) for one in path)
    assert is_free(costmap, path)
    assert max(curvatures(path), default=0.0) <= 1.001 / radius
    assert np.allclose(path[0], start)
    assert math.hypot(*(path[-1, :2] - goal[:2])) <= 0.25 + 1e-9
    assert model == BOTH or backwards(path) == 0.0
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max(initial=0.0) < 2.0 * costmap.resolution


@pytest.mark.parametrize("model", ["DUBIN", BOTH])
def test_on_free_ground_paths_are_about_the_shortest_curves(model):
    asked = planner(motion_model_for_search=model, minimum_turning_radius=0.5)
    for start, goal in ((pose(1.0, 1.0), pose(3.0, 3.0, 1.5)), (pose(2.0, 2.0, 1.0), pose(1.7, 2.3, -2.0))):
        path = asked.create_plan(room(), start, goal)
        dx, dy = (goal - start)[:2] / 0.5
        cosine, sine = math.cos(start[2]), math.sin(start[2])
        least, _, _ = shortest_curve(
            cosine * dx + sine * dy, cosine * dy - sine * dx, goal[2] - start[2], model == BOTH
        )
        assert 0.999 * 0.5 * least <= path_length(path) <= 1.15 * 0.5 * least
        assert np.allclose(path[-1], goal)


def test_the_goal_may_be_met_at_other_headings():
    start, goal = pose(1.0, 2.0), pose(3.0, 2.0, math.pi)
    ends = {}
    for mode in ("DEFAULT", "BIDIRECTIONAL", "ALL_DIRECTION"):
        path = planner(goal_heading_mode=mode).create_plan(room(), start, goal)
        assert np.allclose(path[-1, :2], goal[:2], atol=1e-6)
        ends[mode] = path_length(path), abs(math.remainder(path[-1, 2], 2.0 * math.pi))
    assert ends["DEFAULT"][1] == pytest.approx(math.pi)
    assert ends["BIDIRECTIONAL"] == pytest.approx((2.0, 0.0), abs=1e-3)
    assert ends["ALL_DIRECTION"] == pytest.approx((2.0, 0.0), abs=1e-3)
    goal = pose(2.6, 2.55, 0.1)
    lengths = [
        path_length(
            planner(goal_heading_mode="ALL_DIRECTION", coarse_search_resolution=coarse, smooth_path=False).create_plan(
                room(), start, goal
            )
        )
        for coarse in (1, 6, 72)
    ]
    assert lengths[0] <= lengths[1] + 1e-9 <= lengths[2] + 2e-9


def test_errors():
    refuses_bad_poses(lambda: planner(tolerance=0.0))


def test_a_goal_in_an_obstacle_is_replaced_within_the_tolerance():
    costmap = room()
    costmap.costs[:, 50:] = 254
    start, goal = pose(1.0, 1.0), pose(2.6, 1.0)
    ends = [
        planner(tolerance=0.5, max_on_approach_iterations=count).create_plan(costmap, start, goal)[-1]
        for count in (0, 1000)
    ]
    assert 2.1 < ends[0][0] < ends[1][0] < 2.5
    with pytest.raises(GoalOccupied, match="does not fit"):
        planner(tolerance=0.0).create_plan(costmap, start, goal)


def test_a_search_ends_after_its_iterations_and_its_time_and_when_it_is_not_wanted():
    costmap = room()
    costmap.costs[:60, 40] = 254
    start, goal = pose(1.0, 1.0), pose(3.0, 1.0)
    with pytest.raises(NoPath, match="max_iterations, 20"):
        planner(max_iterations=20).create_plan(costmap, start, goal)
    with pytest.raises(PlanningTimedOut, match="max_planning_time"):
        planner(max_planning_time=1e-9, terminal_checking_interval=1).create_plan(costmap, start, goal)
    stopped = planner(terminal_checking_interval=1)
    stopped.is_cancelled = lambda: True
    with pytest.raises(PlanningCancelled):
        stopped.create_plan(costmap, start, goal)


def test_unknown_cells_may_be_forbidden():
    costmap = room()
    costmap.costs[:, 40] = 255
    assert len(planner().create_plan(costmap, pose(1.0, 1.0), pose(3.0, 1.0))) > 10
    with pytest.raises(NoPath):
        planner(allow_unknown=False).create_plan(costmap, pose(1.0, 1.0), pose(3.0, 1.0))


def test_costs_are_avoided_by_their_weight():
    costmap = room()
    costmap.costs[20:60, 30:50] = 100
    start, goal = pose(0.5, 2.0), pose(3.5, 2.0)

    def under(**parameters):
        asked = planner(smooth_path=False, analytic_expansion_max_length=0.3, **parameters)
        path = asked.create_plan(costmap, start, goal)
        return sum(costmap.cost_at(*one[:2]) == 100 for one in path)

    assert under(cost_penalty=0.0) > 20
    assert under(cost_penalty=5.0) == 0
    assert under(cost_penalty=4.0) == 0
    assert under(cost_penalty=4.0, use_quadratic_cost_penalty=True) > 20


def test_penalties_choose_how_to_drive():
    start, goal = pose(2.0, 2.0), pose(1.2, 2.0)
    asked = {"motion_model_for_search": BOTH, "analytic_expansion_max_length": 0.1}
    assert backwards(planner(**asked).create_plan(room(), start, goal)) > 0.7
    long = planner(reverse_penalty=100.0, **asked).create_plan(room(), start, goal)
    assert backwards(long) < 0.5
    start, goal = pose(0.5, 0.5), pose(3.5, 1.8)
    turns = []
    for penalties in ({}, {"non_straight_penalty": 3.0, "change_penalty": 3.0}):
        path = planner(smooth_path=False, analytic_expansion_max_length=0.1, **penalties).create_plan(
            room(), start, goal
        )
        turns.append(float(np.abs(np.diff(np.unwrap(path[:, 2]))).sum()))
    assert turns[1] <= turns[0] + 1e-6


def furnished(seed=3, edge=80, boxes=8):
    """Return a room with boxes, and a start and a goal in opposite corners."""
    costmap, _ = cluttered(seed, edge, edge, boxes)
    free = np.argwhere(costmap.costs == 0)
    start, goal = (np.array([*costmap.map_to_world(*cell[::-1]), 0.5]) for cell in (free[20], free[-20]))
    return costmap, start, goal


def test_each_option_of_the_search_changes_it():
    costmap, start, goal = furnished()
    base = planner(smooth_path=False).create_plan(costmap, start, goal)
    for option in (
        {"allow_primitive_interpolation": True, "minimum_turning_radius": 0.3, "angle_quantization_bins": 120},
        {"angle_quantization_bins": 16},
        {"minimum_turning_radius": 0.25},
        {"retrospective_penalty": 0.5},
        {"analytic_expansion_max_length": 0.3},
        {"analytic_expansion_ratio": 30.0},
        {"downsample_costmap": True, "downsampling_factor": 2, "tolerance": 0.3},
    ):
        other = planner(**({"smooth_path": False} | option)).create_plan(costmap, start, goal)
        assert other.shape != base.shape or not np.allclose(other, base), option


def test_curves_to_the_goal_avoid_costs_unless_that_is_overridden():
    costmap = room()
    costmap.costs[:, 45:] = 220
    start, goal = pose(1.0, 2.0), pose(3.0, 2.3, 0.4)
    ends = []
    for override in (False, True):
        asked = planner(analytic_expansion_max_cost=200.0, analytic_expansion_max_cost_override=override, tolerance=0.0)
        ends.append(np.allclose(asked.create_plan(costmap, start, goal)[-1], goal))
    assert ends == [False, True]
    assert np.allclose(planner(analytic_expansion_max_cost=230.0).create_plan(costmap, start, goal)[-1], goal)


def test_estimates_are_kept_and_may_be_of_smaller_cells(monkeypatch):
    from daidalos.navigation.planners import cost_to_go

    sizes = []

    def counted(costs, *rest):
        sizes.append(costs.shape)
        return costs_to_goal(costs, *rest)

    monkeypatch.setattr(cost_to_go, "costs_to_goal", counted)
    for parameters in ({}, {"downsample_obstacle_heuristic": False}, {"cache_obstacle_heuristic": True}):
        asked = planner(**parameters)
        for _ in range(2):
            asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0))
    assert sizes == [(40, 40)] * 2 + [(80, 80)] * 2 + [(40, 40)]


def test_smoothing_keeps_ends_and_shortens():
    costmap, start, goal = furnished(2, 120, 14)
    rough = planner(smooth_path=False, minimum_turning_radius=0.2).create_plan(costmap, start, goal)
    lengths = []
    for smoother in ({"max_iterations": 1, "do_refinement": False}, {}):
        asked = planner(smoother=PathSmoothing(**smoother), minimum_turning_radius=0.2)
        path = asked.create_plan(costmap, start, goal)
        assert np.allclose(path[0], rough[0])
        assert np.allclose(path[-1], rough[-1])
        lengths.append(path_length(path))
    assert path_length(rough) > lengths[0] + 1e-3 > lengths[1] + 1e-2


def test_the_table_of_curves_has_its_size_and_changes_no_path_when_kept():
    asked = planner(lookup_table_size=1.0)
    first = asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0, 2.0))
    assert asked._table[1].shape == (21, 11, 72)
    assert np.allclose(first, asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0, 2.0)))
