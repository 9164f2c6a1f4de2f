"""Nodes of a graph for poses: where a route begins and ends, and what of it is passed already."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, NO_INFORMATION
from daidalos.navigation.errors import IndeterminateNodes, NoValidGraph
from daidalos.navigation.routes.costs import RouteCosts, is_blocked
from daidalos.navigation.routes.graph import GraphNode, Route, RouteGraph, closest_point

_NEIGHBORS = ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1))


@dataclass(frozen=True)
class GoalIntentParameters(Parameters):
    """Parameters, by their Nav2 names."""

    prune_goal: bool = parameter(True, "Whether the last node is left out where the goal lies before it.")
    max_prune_dist_from_edge: float = parameter(
        8.0, "Largest distance of a pose from an edge that is left out.", unit="m", minimum=0.0
    )
    min_prune_dist_from_goal: float = parameter(
        0.15, "Least distance of the goal from the last node that is left out.", unit="m", minimum=0.0
    )
    min_prune_dist_from_start: float = parameter(
        0.10, "Least distance of the start from the first node that is left out.", unit="m", minimum=0.0
    )
    enable_nn_search: bool = parameter(
        True, "Whether walls of the costmap are looked at for the node nearest to a pose."
    )
    max_nn_search_iterations: int = parameter(10000, "Largest number of cells of that search.", minimum=1)
    num_nearest_nodes: int = parameter(5, "Nodes that are considered for a pose.", minimum=1)


def node_of(graph: RouteGraph, identifier: int, what: str) -> GraphNode:
    """Return a node of a graph.

    Raises
    ------
    NoValidGraph, IndeterminateNodes
    """
    if not graph.nodes:
        raise NoValidGraph("there is no graph; set 'graph_filepath' or call the service set_route_graph")
    if identifier not in graph.nodes:
        known = sorted(graph.nodes)
        raise IndeterminateNodes(
            f"the {what} node {identifier} does not exist; the graph has {len(known)} nodes from {known[0]} "
            f"to {known[-1]}"
        )
    return graph.nodes[identifier]


def nearest_node(graph: RouteGraph, pose: Array, view: RouteCosts | None, p: GoalIntentParameters) -> GraphNode:
    """Return the node nearest to a pose: by the free way over the costmap where there is one, else by the distance.

    Raises
    ------
    NoValidGraph, IndeterminateNodes
    """
    if not graph.nodes:
        raise NoValidGraph("there is no graph; set 'graph_filepath' or call the service set_route_graph")
    if not np.isfinite(pose).all():
        raise IndeterminateNodes(f"the pose ({pose[0]:g}, {pose[1]:g}, {pose[2]:g}) is not finite")
    candidates = graph.nearest(pose, p.num_nearest_nodes)
    if view is None or not p.enable_nn_search or len(candidates) == 1:
        return candidates[0]
    costs = view.along(candidates[0].point, pose)
    if costs is None or not is_blocked(costs):
        return candidates[0]
    return _nearest_by_free_way(view, pose, candidates, p.max_nn_search_iterations) or candidates[0]


def _nearest_by_free_way(
    view: RouteCosts, pose: Array, candidates: list[GraphNode], max_iterations: int
) -> GraphNode | None:
    """Return the candidate that a breadth-first search over free cells finds first."""
    costmap = view.costmap
    cells = {view.cell(node.point): node for node in reversed(candidates)}
    start = view.cell(pose)
    if not costmap.holds(*start):
        return None
    queue, seen = deque([start]), {start}
    for _ in range(max_iterations):
        if not queue:
            return None
        column, row = queue.popleft()
        if (column, row) in cells:
            return cells[column, row]
        for right, up in _NEIGHBORS:
            cell = (column + right, row + up)
            if cell in seen or not costmap.holds(*cell):
                continue
            cost = int(costmap.costs[cell[1], cell[0]])
            if cost < INSCRIBED_INFLATED_OBSTACLE or cost == NO_INFORMATION:
                seen.add(cell)
                queue.append(cell)
    return None


def prune_start(route: Route, pose: Array, p: GoalIntentParameters) -> Route:
    """Return a route without its first edge where the start is beyond the first node on that edge."""
    if not route.edges:
        return route
    first, second = route.start.point, route.edges[0].end.point
    offset = pose[:2] - first
    is_beyond = float((second - first) @ offset) > 1e-6 and float(np.hypot(*offset)) > p.min_prune_dist_from_start
    away = float(np.hypot(*(closest_point(pose, first, second) - pose[:2])))
    return route.without_first() if is_beyond and away <= p.max_prune_dist_from_edge else route


def prune_goal(route: Route, pose: Array, p: GoalIntentParameters) -> Route:
    """Return a route without its last edge where the goal is before the last node on that edge."""
    if not route.edges or not p.prune_goal:
        return route
    before, last = route.edges[-1].start.point, route.edges[-1].end.point
    offset = pose[:2] - last
    is_before = float((last - before) @ offset) < -1e-6 and float(np.hypot(*offset)) > p.min_prune_dist_from_goal
    away = float(np.hypot(*(closest_point(pose, before, last) - pose[:2])))
    return route.without_last() if is_before and away <= p.max_prune_dist_from_edge else route
