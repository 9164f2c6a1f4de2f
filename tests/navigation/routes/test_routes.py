"""Search, scorers, dense paths, pruning and tracking of routes."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from daidalos.common.extensions import find
from daidalos.common.parameters import parameters_from
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import (
    IndeterminateNodes,
    InvalidScorerUse,
    NoValidGraph,
    NoValidRoute,
    OperationFailed,
    RouteTimedOut,
)
from daidalos.navigation.extensions import EDGE_SCORERS, ROUTE_OPERATIONS
from daidalos.navigation.routes.contracts import NOTHING, Progress, RouteRequest
from daidalos.navigation.routes.costs import RouteCosts
from daidalos.navigation.routes.dense_path import DensePathParameters, dense_path
from daidalos.navigation.routes.goal_intent import (
    GoalIntentParameters,
    nearest_node,
    node_of,
    prune_goal,
    prune_start,
)
from daidalos.navigation.routes.graph import GraphEdge, GraphNode, Route, RouteGraph
from daidalos.navigation.routes.loaders.geojson_graph_file_loader import GeoJsonGraphFileLoader
from daidalos.navigation.routes.search import find_route
from daidalos.navigation.routes.tracker import RouteTracker, TrackerParameters
from navigation.routes.graphs import square, write


@pytest.fixture
def graph(tmp_path: Path) -> RouteGraph:
    return load(tmp_path)


def load(tmp_path: Path, **properties: Any) -> RouteGraph:
    return GeoJsonGraphFileLoader().load(write(tmp_path / "graph.geojson", square(**properties)))


def scorer(name: str, **values: Any) -> Any:
    return extension(EDGE_SCORERS, name, **values)


def extension(kind: Any, name: str, **values: Any) -> Any:
    found: Any = find(kind, f"nav2_route::{name}")
    return found(parameters_from(found.Parameters, values) if found.Parameters else None)


def request(graph: RouteGraph, start: int, goal: int, **poses: Any) -> RouteRequest:
    return RouteRequest(graph.nodes[start], graph.nodes[goal], **poses)


def ids(route: Route) -> list[int]:
    return [edge.id for edge in route.edges]


def test_routes_cost_what_another_library_finds() -> None:
    random = np.random.default_rng(1)
    nodes = [GraphNode(i, *random.uniform(0, 10, 2)) for i in range(60)]
    edges = [GraphEdge(i, *random.choice(nodes, 2, replace=False)) for i in range(200)]
    graph, lengths = RouteGraph(nodes, edges), np.full((60, 60), np.inf)
    for one in edges:
        lengths[one.start.id, one.end.id] = min(lengths[one.start.id, one.end.id], one.length)
    expected = dijkstra(lengths)
    scorers = [scorer("DistanceScorer")]
    found = 0
    for start, goal in itertools.product(range(10), range(10, 20)):
        if not np.isfinite(expected[start, goal]):
            with pytest.raises(NoValidRoute):
                find_route(graph, request(graph, start, goal), scorers)
            continue
        route = find_route(graph, request(graph, start, goal), scorers)
        assert route.cost == pytest.approx(expected[start, goal])
        assert (route.nodes[0].id, route.nodes[-1].id) == (start, goal)
        found += 1
    assert found > 50


def test_closed_edges_and_nodes_are_gone_around(graph: RouteGraph) -> None:
    scorers = [scorer("DistanceScorer"), scorer("DynamicEdgesScorer")]
    assert ids(find_route(graph, request(graph, 0, 1), scorers)) == [10]
    assert ids(find_route(graph, request(graph, 0, 1), scorers, blocked={10})) == [23, 22, 21]
    assert ids(find_route(graph, request(graph, 0, 2), scorers, blocked={1})) == [23, 22]
    with pytest.raises(NoValidRoute, match="from node 0 to node 1; closed: 10, 23"):
        find_route(graph, request(graph, 0, 1), scorers, blocked={10, 23})
    adjust = SimpleNamespace(closed_edges=[10], opened_edges=[], adjust_edges=[])
    scorers[1].adjust(adjust)
    assert ids(find_route(graph, request(graph, 0, 1), scorers)) == [23, 22, 21]
    scorers[1].adjust(SimpleNamespace(closed_edges=[], opened_edges=[10], adjust_edges=[]))
    assert ids(find_route(graph, request(graph, 0, 1), scorers)) == [10]
    scorers[1].adjust(
        SimpleNamespace(closed_edges=[], opened_edges=[], adjust_edges=[SimpleNamespace(edgeid=10, cost=100.0)])
    )
    assert ids(find_route(graph, request(graph, 0, 1), scorers)) == [23, 22, 21]


def test_fixed_costs_and_limits_of_the_search(tmp_path: Path) -> None:
    graph = load(tmp_path, e10={"cost": 50.0, "overridable": False})
    route = find_route(graph, request(graph, 0, 1), [scorer("DistanceScorer")])
    assert (ids(route), route.costs) == ([23, 22, 21], (4.0, 4.0, 4.0))
    with pytest.raises(NoValidGraph, match="fixed cost 0"):
        find_route(graph, request(graph, 1, 2))
    with pytest.raises(RouteTimedOut):
        find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")], max_iterations=1)


@pytest.mark.parametrize(
    ("name", "values", "properties", "cost"),
    [
        ("DistanceScorer", {"weight": 2.0}, {"metadata": {"speed_limit": 0.5}}, 16.0),
        ("DistanceScorer", {"speed_tag": "limit"}, {"metadata": {"limit": 0}}, None),
        ("TimeScorer", {}, {}, 8.0),
        ("TimeScorer", {"weight": 3.0}, {"metadata": {"abs_speed_limit": 2}}, 6.0),
        ("TimeScorer", {}, {"metadata": {"abs_speed_limit": 2, "abs_time_taken": 11.0}}, 11.0),
        ("PenaltyScorer", {"weight": 2.0, "penalty_tag": "wet"}, {"metadata": {"wet": 3}}, 6.0),
        ("PenaltyScorer", {}, {"metadata": {"penalty": "much"}}, 0.0),
        (
            "SemanticScorer",
            {"semantic_classes": ["aisle", "hall"], "aisle": 5.0, "hall": 1.0, "weight": 2.0},
            {"metadata": {"class": "aisle"}},
            10.0,
        ),
        (
            "SemanticScorer",
            {"semantic_classes": ["aisle"], "aisle": 5, "semantic_key": ""},
            {"metadata": {"aisle": 7}},
            5.0,
        ),
    ],
)
def test_scores(tmp_path: Path, name: str, values: Any, properties: Any, cost: float | None) -> None:
    graph = load(tmp_path, e10=properties)
    assert scorer(name, **values).score(graph.edges[0], request(graph, 0, 2)) == cost


def test_orientations_at_start_and_goal(graph: RouteGraph) -> None:
    north = np.array([0.0, 0.0, math.pi / 2])
    poses = request(graph, 0, 2, start_pose=north, goal_pose=north)
    start, goal = scorer("StartPoseOrientationScorer"), scorer("GoalOrientationScorer", orientation_weight=2.0)
    (east,) = [edge for edge in graph.edges if edge.id == 10]
    (up,) = [edge for edge in graph.edges if edge.id == 11]
    (west,) = [edge for edge in graph.edges if edge.id == 22]
    assert start.score(east, poses) == pytest.approx(math.pi / 2)
    assert start.score(up, poses) == 0.0  # not at the start
    assert goal.score(up, poses) == pytest.approx(0.0)
    assert goal.score(west, poses) == pytest.approx(math.pi)
    strict = scorer("StartPoseOrientationScorer", use_orientation_threshold=True, orientation_tolerance=1.0)
    assert strict.score(east, poses) is None
    with pytest.raises(InvalidScorerUse, match="nodes, not poses"):
        start.score(east, request(graph, 0, 2))


def test_costs_of_a_turned_costmap_along_edges(graph: RouteGraph) -> None:
    """An obstacle across edge 10 at x = 2 m, seen by a costmap whose frame is turned by 30 degrees."""
    turned = np.array([1.0, -0.5, math.radians(-30.0)])  # of the graph's frame in the costmap's
    costmap = Costmap.filled(240, 240, 0.05, (-6.0, -6.0))
    view = RouteCosts(costmap, turned)
    column, row = view.cell(np.array([2.0, 0.0]))
    costmap.costs[row - 2 : row + 3, column - 2 : column + 3] = 254
    one = scorer("CostmapScorer", check_resolution=1)
    assert one.score(graph.edges[0], request(graph, 0, 2)) is None  # without a costmap
    one.costs = view
    assert one.score(graph.edges[0], request(graph, 0, 2)) is None
    costmap.costs[costmap.costs > 0] = 100
    assert one.score(graph.edges[0], request(graph, 0, 2)) == pytest.approx(100 / 253)
    mean = scorer("CostmapScorer", use_maximum=False)
    mean.costs = view
    assert 0.0 < mean.score(graph.edges[0], request(graph, 0, 2)) < 0.1
    one.costs = RouteCosts(Costmap.filled(10, 10, 0.05, (0.0, 0.0)))
    assert one.score(graph.edges[0], request(graph, 0, 2)) is None
    assert scorer("CostmapScorer", invalid_off_map=False).score(graph.edges[0], request(graph, 0, 2)) is None


def test_paths_are_dense_and_corners_round(graph: RouteGraph) -> None:
    route = find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")])
    sharp = dense_path(route, DensePathParameters())
    assert sharp[0] == pytest.approx([0.0, 0.0, 0.0])
    assert sharp[-1] == pytest.approx([4.0, 4.0, math.pi / 2])
    assert np.hypot(*np.diff(sharp[:, :2], axis=0).T).max() <= 0.05 + 1e-9
    round_ = dense_path(route, DensePathParameters(smooth_corners=True))
    center = np.array([3.0, 1.0])
    in_corner = round_[(round_[:, 0] > 3.0) & (round_[:, 1] < 1.0)]
    assert np.hypot(*(in_corner[:, :2] - center).T) == pytest.approx(np.ones(len(in_corner)), abs=1e-9)
    assert np.abs(np.diff(round_[:, 2])).max() < 0.06
    warnings: list[str] = []
    dense_path(route, DensePathParameters(smooth_corners=True, smoothing_radius=5.0), warn=warnings.append)
    assert warnings == ["the corner at (4.00, 0.00) has no room for an arc of radius 5 m"]
    assert dense_path(Route(graph.nodes[2]), DensePathParameters()).tolist() == [[4.0, 4.0, 0.0]]


def test_the_nearest_node_is_the_one_on_this_side_of_a_wall(graph: RouteGraph) -> None:
    p, pose = GoalIntentParameters(), np.array([0.0, 1.5, 0.0])
    assert nearest_node(graph, pose, None, p).id == 0
    costmap = Costmap.filled(120, 120, 0.05, (-1.0, -1.0))
    costmap.costs[40, :] = 254  # a wall at y = 1
    assert nearest_node(graph, pose, RouteCosts(costmap), p).id == 3
    assert nearest_node(graph, pose, RouteCosts(costmap), GoalIntentParameters(enable_nn_search=False)).id == 0
    with pytest.raises(NoValidGraph, match="set 'graph_filepath'"):
        nearest_node(RouteGraph(), pose, None, p)
    with pytest.raises(IndeterminateNodes, match="goal node 9 does not exist; the graph has 4 nodes from 0 to 3"):
        node_of(graph, 9, "goal")
    with pytest.raises(IndeterminateNodes, match="not finite"):
        nearest_node(graph, np.array([math.nan, 0.0, 0.0]), None, p)


def test_ends_that_are_passed_are_left_out(graph: RouteGraph) -> None:
    p = GoalIntentParameters()
    route = find_route(graph, request(graph, 0, 3), [scorer("DistanceScorer")], blocked={23})
    assert ids(prune_start(route, np.array([1.0, 0.3, 0.0]), p)) == [11, 12]
    assert prune_start(route, np.array([-1.0, 0.0, 0.0]), p) is route
    assert prune_start(route, np.array([0.05, 0.0, 0.0]), p) is route
    assert ids(prune_goal(route, np.array([1.0, 4.0, 0.0]), p)) == [10, 11]
    assert prune_goal(route, np.array([-1.0, 4.0, 0.0]), p) is route
    assert prune_goal(route, np.array([1.0, 4.0, 0.0]), GoalIntentParameters(prune_goal=False)) is route


def test_a_robot_is_tracked_past_nodes(graph: RouteGraph) -> None:
    route = find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")])
    tracker = RouteTracker(route, TrackerParameters(radius_to_achieve_node=1.0, boundary_radius_to_achieve_node=0.5))
    assert not tracker.update(np.array([-2.0, 0.0, 0.0]))
    assert tracker.update(np.array([-0.4, 0.0, 0.0]))
    assert (tracker.last_node, tracker.edge) == (graph.nodes[0], route.edges[0])
    assert not tracker.update(np.array([3.5, 0.0, 0.0]))  # within the radius, before the bisector
    assert tracker.update(np.array([3.7, 0.5, 0.0]))  # cut across the corner
    progress = tracker.progress(np.zeros(3))
    assert (progress.node, progress.edge, progress.left) == (graph.nodes[1], route.edges[1], route.edges[0])
    assert not tracker.is_completed
    assert tracker.update(np.array([4.0, 3.6, 0.0]))
    assert tracker.is_completed
    assert not tracker.update(np.array([4.0, 3.6, 0.0]))


def test_a_node_that_is_left_behind_counts(graph: RouteGraph) -> None:
    route = find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")])
    tracker = RouteTracker(route, TrackerParameters(radius_to_achieve_node=1.0), route.edges[0])
    assert tracker.last_node is graph.nodes[0]
    tracker.update(np.array([0.0, 0.0, 0.0]))
    assert not tracker.update(np.array([3.2, 0.0, 0.0]))
    assert tracker.update(np.array([2.5, 0.0, 0.0]))


def test_obstacles_ahead_are_routed_around(graph: RouteGraph) -> None:
    route = find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")])
    monitor = extension(ROUTE_OPERATIONS, "CollisionMonitor", max_collision_dist=3.0, rate=1.0)
    on_first = Progress(route, np.array([0.5, 0.0, 0.0]), graph.nodes[0], route.edges[0])
    with pytest.raises(OperationFailed, match="no costmap on 'local_costmap/costmap_raw'"):
        monitor.perform(on_first, 100.0, {})
    costmap = Costmap.filled(100, 100, 0.05, (-0.5, -0.5))
    monitor.costs = RouteCosts(costmap)
    assert monitor.perform(on_first, 101.0, {}) == NOTHING
    costmap.costs[:, 85:] = 254  # from x = 3.75 on: beyond 3 m ahead
    assert monitor.perform(on_first, 102.0, {}) == NOTHING
    nearer = Progress(route, np.array([1.5, 0.0, 0.0]), graph.nodes[0], route.edges[0])
    assert monitor.perform(nearer, 102.5, {}) == NOTHING  # not due
    assert monitor.perform(nearer, 103.0, {}).blocked == (10,)
    costmap.costs[:, 85:] = 0
    costmap.costs[30:, :] = 254  # on the next edge
    assert monitor.perform(Progress(route, np.array([3.0, 0.0, 0.0]), None, route.edges[0]), 104.0, {}).blocked == (11,)
    strict = extension(ROUTE_OPERATIONS, "CollisionMonitor", reroute_on_collision=False)
    strict.costs = monitor.costs
    with pytest.raises(OperationFailed, match="edge 11 of the route is blocked"):
        strict.perform(on_first, 105.0, {})


def test_times_on_edges_are_measured(graph: RouteGraph) -> None:
    route = find_route(graph, request(graph, 0, 2), [scorer("DistanceScorer")])
    marker = extension(ROUTE_OPERATIONS, "TimeMarker")
    first, second = route.edges
    marker.perform(Progress(route, np.zeros(3), graph.nodes[0], first), 10.0, {})
    marker.perform(Progress(route, np.zeros(3), graph.nodes[1], second, first), 17.5, {})
    assert first.metadata == {"abs_time_taken": 7.5}
    assert scorer("TimeScorer").score(first, request(graph, 0, 2)) == 7.5
