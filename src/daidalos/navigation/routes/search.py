"""Search for the cheapest route through a graph."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Collection, Iterator, Sequence

from daidalos.navigation.errors import NoValidGraph, NoValidRoute, RouteTimedOut
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge, Route, RouteGraph

_CHECK_EVERY = 1000
"""Expanded nodes between two looks at the clock."""


def find_route(
    graph: RouteGraph,
    request: RouteRequest,
    scorers: Sequence[EdgeScorer] = (),
    *,
    blocked: Collection[int] = (),
    max_iterations: int = 0,
    is_late: Callable[[], bool] = lambda: False,
) -> Route:
    """Return the cheapest route by Dijkstra's algorithm.

    Parameters
    ----------
    graph : RouteGraph
    request : RouteRequest
    scorers : sequence of EdgeScorer
        Their costs are added. Edges that may not be overridden have the cost of the graph.
    blocked : collection of int
        Edges that must not be used and nodes that must not be entered.
    max_iterations : int
        Largest number of nodes that are expanded; 0 for any number.
    is_late : callable
        Returns whether the search has taken too long.

    Raises
    ------
    NoValidRoute, NoValidGraph, RouteTimedOut, InvalidScorerUse
    """
    if not graph.nodes:
        raise NoValidGraph("there is no graph")
    best = {request.start.id: 0.0}
    reached_by: dict[int, tuple[GraphEdge, float]] = {}
    queue, done = [(0.0, request.start.id)], set[int]()
    while queue:
        cost, identifier = heapq.heappop(queue)
        if identifier in done:
            continue
        if identifier == request.goal.id:
            return _route(request, reached_by)
        done.add(identifier)
        if 0 < max_iterations <= len(done) or (len(done) % _CHECK_EVERY == 0 and is_late()):
            raise RouteTimedOut(f"no route to node {request.goal.id} was found after {len(done)} nodes")
        for edge, step in _open_edges(graph, identifier, request, scorers, blocked):
            if cost + step < best.get(edge.end.id, math.inf):
                best[edge.end.id] = cost + step
                reached_by[edge.end.id] = (edge, step)
                heapq.heappush(queue, (cost + step, edge.end.id))
    closed = f"; closed: {', '.join(str(one) for one in sorted(blocked))}" if blocked else ""
    raise NoValidRoute(f"there is no open route from node {request.start.id} to node {request.goal.id}{closed}")


def _route(request: RouteRequest, reached_by: dict[int, tuple[GraphEdge, float]]) -> Route:
    """Return the route that the search found, from its end on."""
    steps = []
    node = request.goal.id
    while node != request.start.id:
        steps.append(reached_by[node])
        node = steps[-1][0].start.id
    steps.reverse()
    return Route(request.start, tuple(edge for edge, _ in steps), tuple(cost for _, cost in steps))


def _open_edges(
    graph: RouteGraph, identifier: int, request: RouteRequest, scorers: Sequence[EdgeScorer], blocked: Collection[int]
) -> Iterator[tuple[GraphEdge, float]]:
    """Yield the edges that leave a node and may be used, with their costs."""
    for edge in graph.edges_from(graph.nodes[identifier]):
        if edge.id in blocked or edge.end.id in blocked:
            continue
        if edge.overridable and scorers:
            cost = _scored(edge, request, scorers)
            if cost is not None:
                yield edge, cost
        elif edge.cost > 0.0:
            yield edge, edge.cost
        else:
            raise NoValidGraph(f"edge {edge.id} has the fixed cost {edge.cost:g}, expected more than 0")


def _scored(edge: GraphEdge, request: RouteRequest, scorers: Sequence[EdgeScorer]) -> float | None:
    """Return the sum of all scores, at least 0; None where a scorer closes the edge."""
    total = 0.0
    for scorer in scorers:
        score = scorer.score(edge, request)
        if score is None:
            return None
        total += score
    return max(total, 0.0)
