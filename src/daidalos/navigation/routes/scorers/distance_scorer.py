"""Scorer of the length of edges."""

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class DistanceScorerParameters(Parameters):
    """Parameters of the scorer, by their Nav2 names."""

    weight: float = parameter(1.0, "Factor of the cost.", minimum=0.0)
    speed_tag: str = parameter("speed_limit", "Metadata with the share of the speed that is allowed.", not_empty=True)


class DistanceScorer(EdgeScorer):
    """Scorer of the length, divided by the speed limit of the edge where it has one."""

    names = ("nav2_route::DistanceScorer",)
    Parameters = DistanceScorerParameters
    parameters: DistanceScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`; an edge with a limit of zero is closed."""
        limit = edge.number(self.parameters.speed_tag, 1.0)
        return self.parameters.weight * edge.length / limit if limit > 0.0 else None
