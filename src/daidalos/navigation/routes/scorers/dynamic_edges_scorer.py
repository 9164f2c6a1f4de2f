"""Scorer of edges that are closed and opened while the server runs."""

from typing import Any

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest, ServiceOffer
from daidalos.navigation.routes.graph import GraphEdge


class DynamicEdgesScorer(EdgeScorer):
    """Scorer of costs that a service sets; it closes and opens edges too."""

    names = ("nav2_route::DynamicEdgesScorer",)

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._closed: set[int] = set()
        self._costs: dict[int, float] = {}

    @property
    def services(self) -> tuple[ServiceOffer, ...]:
        """Implement `RouteExtension.services`."""
        return (ServiceOffer("adjust_edges", "nav2_msgs/srv/DynamicEdges", self.adjust),)

    def adjust(self, request: Any) -> None:
        """Close, open and adjust the edges of a ``nav2_msgs/srv/DynamicEdges`` request."""
        self._closed |= set(request.closed_edges)
        self._closed -= set(request.opened_edges)
        self._costs |= {one.edgeid: float(one.cost) for one in request.adjust_edges}

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        return None if edge.id in self._closed else self._costs.get(edge.id, 0.0)
