"""State lattice planner: paths that the robot can drive and that touch nothing, and each parameter."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.errors import GoalOccupied, NoPath, PlannerError, PlanningCancelled, PlanningTimedOut
from daidalos.navigation.paths import path_length
from daidalos.navigation.planners import cost_to_go
from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.smac_parameters import PathSmoothing
from daidalos.navigation.planners.smac_planner_lattice import SmacPlannerLattice, SmacPlannerLatticeParameters
from daidalos.navigation.planners.state_lattice import lattice_document
from properties import examples

from .common import is_free, pose, refuses_bad_poses, room
from .test_smac_planner_hybrid import OUTLINE, backwards, curvatures, furnished
from .worlds import cluttered, random_pose


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return a lattice's file of each motion model and turning radius."""
    folder = tmp_path_factory.mktemp("lattices")

    def file(model, radius=0.3, **options):
        path = folder / f"{model}_{radius}_{len(options)}.json"
        if not path.exists():
            lattice = generate_lattice(LatticeOptions(model, radius, **options))
            path.write_text(json.dumps(lattice_document(lattice, {}, "2026-01-01")))
        return str(path)

    return file


def planner(footprint=None, **parameters):
    parameters.setdefault("lookup_table_size", 3.0)
    context = None if footprint is None else NavigationContext(footprint=footprint)
    return SmacPlannerLattice(SmacPlannerLatticeParameters(**parameters), context)


@examples(40)
@given(
    seed=st.integers(0, 10_000),
    model=st.sampled_from(["ackermann", "diff", "omni"]),
    mode=st.sampled_from(["DEFAULT", "BIDIRECTIONAL", "ALL_DIRECTION"]),
    is_reversible=st.booleans(),
    is_round=st.booleans(),
    radius=st.sampled_from([0.2, 0.4, 0.7]),
)
def test_paths_can_be_driven_and_touch_nothing(files, seed, model, mode, is_reversible, is_round, radius):
    costmap, generator = cluttered(seed, boxes=5)
    start, goal = (random_pose(costmap, generator) for _ in range(2))
    asked = planner(
        None if is_round else OUTLINE, lattice_filepath=files(model, radius), allow_reverse_expansion=is_reversible,
        goal_heading_mode=mode, coarse_search_resolution=4,
    )  # fmt: skip
    try:
        path = asked.create_plan(costmap, start, goal)
    except PlannerError:
        return
    checker = FootprintCollisionChecker(costmap, asked.context.footprint)
    assert not any(checker.in_collision(one) for one in path)
    assert is_free(costmap, path)
    assert np.allclose(path[0], start)
    assert math.hypot(*(path[-1, :2] - goal[:2])) <= 0.25 + 1e-9
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max(initial=0.0) < 2.0 * costmap.resolution
    if model != "omni":
        assert is_reversible or backwards(path) == 0.0
        moves = np.concatenate([[True], np.diff(path[:, :2], axis=0).any(axis=1)])
        turns = np.flatnonzero(~moves)
        assert model == "diff" or turns.size == 0
        for part in np.split(path, turns):
            assert max(curvatures(part), default=0.0) <= 1.01 / radius


def test_on_free_ground_paths_are_about_as_long_as_the_way():
    for yaw in (0.0, 0.2, 1.0, 2.9):
        start = pose(2.0, 2.0, yaw)
        goal = start + pose(1.6 * math.cos(yaw), 1.6 * math.sin(yaw))
        path = planner().create_plan(room(), start, goal)
        assert path_length(path) == pytest.approx(1.6, abs=1e-6)
        assert np.allclose(path[-1], goal)
        path = planner(analytic_expansion_max_length=0.1).create_plan(room(), start, goal)
        assert path_length(path) == pytest.approx(1.6, abs=0.05)
        assert np.allclose(path[-1], goal, atol=0.05)


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
    assert 2.1 < ends[0][0] <= ends[1][0] < 2.5
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


def test_motions_are_driven_backwards_where_that_is_allowed_and_cheap():
    start, goal = pose(2.5, 2.0), pose(1.3, 2.0)
    asked = {"analytic_expansion_max_length": 0.1}
    assert backwards(planner(**asked).create_plan(room(), start, goal)) == 0.0
    asked["allow_reverse_expansion"] = True
    assert backwards(planner(**asked).create_plan(room(), start, goal)) > 1.0
    assert backwards(planner(reverse_penalty=100.0, **asked).create_plan(room(), start, goal)) < 0.6


def test_turns_in_place_are_taken_when_they_are_cheap(files):
    start, goal = pose(1.0, 2.0), pose(1.2, 2.0, math.pi)

    def turned_in_place(**parameters):
        asked = planner(lattice_filepath=files("diff"), analytic_expansion_max_length=0.1, **parameters)
        path = asked.create_plan(room(), start, goal)
        still = ~np.diff(path[:, :2], axis=0).any(axis=1)
        return float(np.abs(np.remainder(np.diff(path[:, 2])[still] + np.pi, 2.0 * np.pi) - np.pi).sum())

    assert turned_in_place(rotation_penalty=0.5) == pytest.approx(math.pi, abs=0.1)
    assert turned_in_place(rotation_penalty=100.0) == 0.0


def test_a_holonomic_robot_goes_sideways(files):
    asked = planner(lattice_filepath=files("omni"), analytic_expansion_max_length=0.3)
    path = asked.create_plan(room(), pose(2.0, 1.0), pose(2.0, 2.5))
    assert path_length(path) == pytest.approx(1.5, abs=1e-6)
    assert path[:, 2] == pytest.approx(np.zeros(len(path)), abs=1e-6)
    path = planner(lattice_filepath=files("omni")).create_plan(room(), pose(2.0, 1.0), pose(2.0, 2.5, 1.0))
    assert path_length(path) == pytest.approx(1.5, abs=0.02)
    assert (np.diff(path[:, 2]) >= -1e-9).all()


def test_turns_cost_what_their_penalties_say():
    start, goal = pose(0.5, 0.5), pose(3.5, 1.8)
    turns = []
    for penalties in ({"non_straight_penalty": 1.0, "change_penalty": 0.0}, {"non_straight_penalty": 3.0}):
        asked = planner(smooth_path=False, analytic_expansion_max_length=0.1, **penalties)
        turns.append(float(np.abs(np.diff(np.unwrap(asked.create_plan(room(), start, goal)[:, 2]))).sum()))
    assert turns[1] <= turns[0] + 1e-6


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


def test_coarse_goals_are_tried_first_and_those_beside_the_best_next(monkeypatch):
    costmap = room()
    start, goal = pose(1.0, 1.0), pose(2.6, 1.55, 0.1)
    lengths = {}
    for coarse in (1, 4, 16):
        asked = planner(goal_heading_mode="ALL_DIRECTION", coarse_search_resolution=coarse, smooth_path=False)
        lengths[coarse] = path_length(asked.create_plan(costmap, start, goal))
    assert lengths[1] <= lengths[4] + 1e-9 <= lengths[16] + 2e-9


def test_each_option_of_the_search_changes_it(files):
    costmap, start, goal = furnished()
    base = planner(smooth_path=False).create_plan(costmap, start, goal)
    for option in (
        {"lattice_filepath": files("ackermann", 0.3)},
        {"lattice_filepath": files("ackermann", 0.5, num_of_headings=32)},
        {"lattice_filepath": files("ackermann", 0.5, grid_resolution=0.1)},
        {"retrospective_penalty": 0.5},
        {"analytic_expansion_max_length": 0.3},
        {"analytic_expansion_ratio": 30.0},
        {"change_penalty": 3.0, "non_straight_penalty": 2.0},
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
    sizes = []
    compute = cost_to_go.costs_to_goal

    def counted(costs, *rest):
        sizes.append(costs.shape)
        return compute(costs, *rest)

    monkeypatch.setattr(cost_to_go, "costs_to_goal", counted)
    for parameters in ({}, {"downsample_obstacle_heuristic": False}, {"cache_obstacle_heuristic": True}):
        asked = planner(**parameters)
        for _ in range(2):
            asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0))
    assert sizes == [(40, 40)] * 2 + [(80, 80)] * 2 + [(40, 40)]


@pytest.mark.parametrize("model", ["ackermann", "omni"])
def test_smoothing_keeps_ends_and_shortens(files, model):
    costmap, start, goal = furnished(2, 120, 14)
    file = files(model, 0.2)
    rough = planner(lattice_filepath=file, smooth_path=False).create_plan(costmap, start, goal)
    lengths = []
    for smoother in ({"max_iterations": 1, "do_refinement": False}, {}):
        path = planner(lattice_filepath=file, smoother=PathSmoothing(**smoother)).create_plan(costmap, start, goal)
        assert np.allclose(path[[0, -1]], rough[[0, -1]])
        lengths.append(path_length(path))
    assert path_length(rough) > lengths[0] > lengths[1]


def test_the_table_of_curves_has_its_size():
    asked = planner(lookup_table_size=1.0)
    first = asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0, 2.0))
    assert asked._table[1].shape == (21, 11, 72)
    assert np.allclose(first, asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 3.0, 2.0)))


def test_a_file_that_cannot_be_used_is_refused_in_one_line(tmp_path, files):
    with pytest.raises(ParameterError, match=r"'lattice_filepath' names a file that cannot be used: .*no.json: cannot"):
        planner(lattice_filepath=str(tmp_path / "no.json"))
    content = json.loads(Path(files("ackermann")).read_text(encoding="utf-8"))
    content["lattice_metadata"]["heading_angles"][8] += 0.05
    for one in content["primitives"]:
        if one["end_angle_index"] == 8:
            one["poses"][-1][2] += 0.05
    crooked = tmp_path / "crooked.json"
    crooked.write_text(json.dumps(content))
    with pytest.raises(ParameterError, match="'allow_reverse_expansion' needs opposite headings"):
        planner(lattice_filepath=str(crooked), allow_reverse_expansion=True)
    asked = planner(lattice_filepath=str(crooked))
    asked.reconfigure(SmacPlannerLatticeParameters())
    assert asked.create_plan(room(), pose(1.0, 1.0), pose(3.0, 1.0)).shape[0] > 10
