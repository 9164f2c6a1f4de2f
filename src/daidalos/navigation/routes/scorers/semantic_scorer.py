"""Scorer of classes of edges and nodes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class SemanticClass(Parameters):
    """Cost of one class."""

    cost: float = parameter(0.0, "Cost of edges and of end nodes of the class.", name="", takes_integer=True)


@dataclass(frozen=True)
class SemanticScorerParameters(Parameters):
    """Parameters of the scorer, by their Nav2 names."""

    weight: float = parameter(1.0, "Factor of the cost.", minimum=0.0)
    semantic_classes: tuple[str, ...] = parameter((), "Names of the classes.", unique=True, read_only=True)
    semantic_key: str = parameter("class", "Metadata with the class; where empty, the keys are the classes.")
    classes: Mapping[str, SemanticClass] = per_name(SemanticClass, by="semantic_classes", at="")


class SemanticScorer(EdgeScorer):
    """Scorer of the classes of an edge and of the node at its end."""

    names = ("nav2_route::SemanticScorer",)
    Parameters = SemanticScorerParameters
    parameters: SemanticScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        return self.parameters.weight * (self._cost(edge.metadata) + self._cost(edge.end.metadata))

    def _cost(self, metadata: Mapping[str, Any]) -> float:
        p = self.parameters
        found = [metadata.get(p.semantic_key)] if p.semantic_key else list(metadata)
        return sum(p.classes[one].cost for one in found if isinstance(one, str) and one in p.classes)
