"""Scorer of penalties that the graph gives edges."""

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class PenaltyScorerParameters(Parameters):
    """Parameters of the scorer, by their Nav2 names."""

    weight: float = parameter(1.0, "Factor of the cost.", minimum=0.0)
    penalty_tag: str = parameter("penalty", "Metadata with the penalty.", not_empty=True)


class PenaltyScorer(EdgeScorer):
    """Scorer of a number in the metadata of an edge."""

    names = ("nav2_route::PenaltyScorer",)
    Parameters = PenaltyScorerParameters
    parameters: PenaltyScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        return self.parameters.weight * edge.number(self.parameters.penalty_tag, 0.0)
