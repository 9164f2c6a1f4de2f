"""Each critic of DWB against its definition, written with plain numpy."""

import math

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from daidalos.navigation.contracts import TrajectoryScene
from daidalos.navigation.controllers.dwb.critics.base_obstacle_critic import (
    BaseObstacleCritic,
    ObstacleCriticParameters,
    ObstacleFootprintCritic,
)
from daidalos.navigation.controllers.dwb.critics.command_critics import PreferForwardCritic, TwirlingCritic
from daidalos.navigation.controllers.dwb.critics.goal_critics import GoalAlignCritic, GoalDistCritic
from daidalos.navigation.controllers.dwb.critics.oscillation_critic import OscillationCritic
from daidalos.navigation.controllers.dwb.critics.path_critics import PathAlignCritic, PathDistCritic, path_inside
from daidalos.navigation.controllers.dwb.critics.rotate_to_goal_critic import RotateToGoalCritic
from daidalos.navigation.controllers.dwb.map_grid import MapGridParameters, manhattan_distances
from daidalos.navigation.controllers.dwb.trajectories import GeneratorParameters, generate
from daidalos.navigation.costmap.footprint import Footprint

from ..scenes import control, ground, line
from .test_trajectories import WAFFLE

BOX = Footprint.of_corners(np.array([[0.3, 0.1], [0.3, -0.1], [-0.3, -0.1], [-0.3, 0.1]]))


@pytest.fixture
def trajectories():
    return generate(GeneratorParameters(**WAFFLE), np.zeros(3), np.array([0.2, 0.0, 0.0]), 0.05, 1.0)


def scene(path, tolerance=0.25, **more):
    return TrajectoryScene(control(path, **more), BOX, tolerance, 0.25)


def ends(trajectories):
    return trajectories.poses[np.arange(trajectories.counts.size), trajectories.counts - 1]


def grid_distance(costmap, targets, point):
    """Return the number of steps over free cells, by Dijkstra's algorithm of scipy."""
    height, width = costmap.costs.shape
    index = np.arange(height * width).reshape(height, width)
    free = costmap.costs < 253
    pairs = [(index[:, :-1], index[:, 1:], free[:, :-1] & free[:, 1:]), (index[:-1], index[1:], free[:-1] & free[1:])]
    rows = np.concatenate([a[ok] for a, _, ok in pairs])
    columns = np.concatenate([b[ok] for _, b, ok in pairs])
    graph = coo_array((np.ones(rows.size), (rows, columns)), shape=(index.size, index.size))
    cells = [costmap.world_to_map(x, y) for x, y in targets]
    found = dijkstra(graph, directed=False, indices=[index[r, c] for c, r in cells], unweighted=True, min_only=True)
    column, row = costmap.world_to_map(*point)
    return found[index[row, column]]


def test_obstacles_under_the_centre_and_under_the_outline(trajectories):
    given = scene(line((2.0, 0.0)), costmap=ground([(0.45, 0.32)]))
    costmap = given.control.costmap
    centre, outline = (critic().score(trajectories, given) for critic in (BaseObstacleCritic, ObstacleFootprintCritic))
    total = BaseObstacleCritic(ObstacleCriticParameters(scale=0.02, sum_scores=True)).score(trajectories, given)
    for k, count in enumerate(trajectories.counts):
        under = [costmap.cost_at(float(x), float(y)) for x, y, _ in trajectories.poses[k, :count]]
        if max(under) >= 253:
            assert math.isinf(centre[k])
            assert math.isinf(total[k])
        else:
            assert centre[k] == under[-1]
            assert total[k] == pytest.approx(0.02 * sum(under))
    assert 0 < np.isinf(centre).sum() <= np.isinf(outline).sum() < outline.size


def test_what_leaves_the_costmap_or_is_unknown_is_impossible(trajectories):
    far = generate(GeneratorParameters(**WAFFLE), np.array([2.99, 0.0, 0.0]), np.zeros(3), 0.05, 1.0)
    given = scene(line((2.9, 0.0)))
    assert np.isinf(BaseObstacleCritic().score(far, given)).any()
    assert np.isinf(ObstacleFootprintCritic().score(far, given)).all()
    given.control.costmap.costs[:] = 255
    assert np.isinf(BaseObstacleCritic().score(trajectories, given)).all()


def test_distances_go_around_obstacles():
    wall = ground([(0.5, y) for y in np.arange(-1.0, 1.0, 0.04)])
    seeds = np.array([wall.world_to_map(1.0, 0.0)])
    found = manhattan_distances(wall.costs, seeds)
    for point in ((0.0, 0.0), (0.1, 1.3), (-2.0, 2.0)):
        column, row = wall.world_to_map(*point)
        assert found[row, column] == grid_distance(wall, [(1.0, 0.0)], point)
    column, row = wall.world_to_map(0.5, 0.0)
    assert found[row, column] >= wall.costs.size


@pytest.mark.parametrize("critic", [PathDistCritic, GoalDistCritic])
def test_distance_critics_count_cells_to_the_end(trajectories, critic):
    path = line((1.0, 0.8))
    given = scene(path, costmap=ground([(0.6, 0.0)]))
    costs = critic(MapGridParameters(scale=32.0)).score(trajectories, given)
    targets = path[:, :2] if critic is PathDistCritic else path[-1:, :2]
    for k in range(0, costs.size, 37):
        if math.isfinite(costs[k]):
            steps = grid_distance(given.control.costmap, targets, ends(trajectories)[k, :2])
            assert costs[k] == pytest.approx(32.0 * 0.5 * 0.05 * steps)
    assert np.isfinite(costs).any()


def test_align_critics_judge_a_point_before_the_robot(trajectories):
    given = scene(line((2.0, 0.0)))
    turned = np.abs(ends(trajectories)[:, 2])
    for critic in (PathAlignCritic(), GoalAlignCritic()):
        costs = critic.score(trajectories, given)
        straight, away = costs[turned < 0.05], costs[turned > 1.0]
        assert straight.max() < away.min()
    near = scene(line((0.3, 0.0)))
    assert not PathAlignCritic().score(trajectories, near).any()


def test_a_path_is_cut_where_it_leaves_the_costmap():
    inside = path_inside(np.array([[2.0, 0.0, 0.0], [5.0, 0.0, 0.0], [2.5, 0.0, 0.0]]), ground())
    assert inside[0] == pytest.approx([2.0, 0.0])
    assert inside[-1, 0] == pytest.approx(3.0, abs=0.06)
    assert np.hypot(*np.diff(inside, axis=0).T).max() <= 0.05 + 1e-9
    assert path_inside(line((9.0, 9.0), start=(8.0, 8.0)), ground()).shape == (0, 2)


def test_rotate_to_goal_stops_first_and_turns_then(trajectories):
    critic = RotateToGoalCritic()
    assert not critic.score(trajectories, scene(line((1.0, 0.0)))).any()
    speeds = np.hypot(trajectories.commands[:, 0], trajectories.commands[:, 1])
    fast = critic.score(trajectories, scene(line((0.1, 0.0), heading=1.0), velocity=(0.3, 0.0, 0.0)))
    expected = 5.0 * speeds + np.abs(ends(trajectories)[:, 2] - 1.0)
    assert np.allclose(fast, expected)
    standing = critic.score(trajectories, scene(line((0.1, 0.0), heading=1.0), velocity=(0.1, 0.0, 0.0)))
    assert np.isinf(standing[speeds > 0.0]).all()
    assert np.isfinite(standing[speeds == 0.0]).all()
    again = critic.score(trajectories, scene(line((0.1, 0.0), heading=1.0), velocity=(0.3, 0.0, 0.0)))
    assert np.array_equal(again, standing)  # it has stood, and turns until the next goal
    critic.reset()
    assert np.isfinite(critic.score(trajectories, scene(line((0.1, 0.0)), velocity=(0.3, 0.0, 0.0)))).any()


def test_oscillation_is_forbidden_until_the_robot_has_moved():
    parameters = GeneratorParameters(**{**WAFFLE, "min_vel_x": -0.26})
    trajectories = generate(parameters, np.zeros(3), np.zeros(3), 0.05, 1.0)
    critic, given = OscillationCritic(), scene(line((2.0, 0.0)))
    critic.note(np.zeros(3), np.array([0.2, 0.0, 0.0]))
    assert not np.isinf(critic.score(trajectories, given)).any()
    critic.note(np.array([0.01, 0.0, 0.0]), np.array([-0.2, 0.0, 0.0]))
    refused = np.isinf(critic.score(trajectories, given))
    assert np.array_equal(refused, trajectories.commands[:, 0] > 0.0)
    critic.note(np.array([-0.05, 0.0, 0.0]), np.array([-0.2, 0.0, 0.0]))
    assert not np.isinf(critic.score(trajectories, given)).any()


def test_turns_may_alternate_while_the_robot_drives():
    trajectories = generate(GeneratorParameters(**WAFFLE), np.zeros(3), np.zeros(3), 0.05, 1.0)
    critic, given = OscillationCritic(), scene(line((2.0, 0.0)))
    for turn in (0.5, -0.5, 0.5):
        critic.note(np.zeros(3), np.array([0.2, 0.0, turn]))
    assert not np.isinf(critic.score(trajectories, given)).any()
    for turn in (0.5, -0.5):
        critic.note(np.zeros(3), np.array([0.0, 0.0, turn]))
    refused = np.isinf(critic.score(trajectories, given))
    assert refused.any()
    assert (trajectories.commands[refused, 2] > 0.0).all()


def test_commands_alone(trajectories):
    given = scene(line((2.0, 0.0)))
    turns = np.abs(trajectories.commands[:, 2])
    assert np.allclose(TwirlingCritic().score(trajectories, given), turns)
    slow = (trajectories.commands[:, 0] < 0.1) & (turns < 0.2)
    assert np.allclose(PreferForwardCritic().score(trajectories, given), np.where(slow, 1.0, 10.0 * turns))
