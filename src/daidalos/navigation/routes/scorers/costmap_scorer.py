"""Scorer of the costs of a costmap along edges."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.costmap.costmap import NO_INFORMATION
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.costs import is_blocked
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class CostmapScorerParameters(Parameters):
    """Parameters of the scorer, by their Nav2 names."""

    weight: float = parameter(1.0, "Factor of the cost.", minimum=0.0)
    costmap_topic: str = parameter(
        "global_costmap/costmap_raw", "Topic of the costmap.", not_empty=True, read_only=True
    )
    max_cost: float = parameter(253.0, "Cost from which on an edge is blocked; 255: never.", above=0.0, maximum=255.0)
    use_maximum: bool = parameter(True, "Whether the largest cost counts, rather than the mean.")
    invalid_on_collision: bool = parameter(True, "Whether blocked edges are closed.")
    invalid_off_map: bool = parameter(True, "Whether edges that leave the costmap are closed.")
    check_resolution: int = parameter(
        2, "Looks at every cell where 1, at every other where 2.", unit="cells", minimum=1
    )


class CostmapScorer(EdgeScorer):
    """Scorer of the largest or the mean cost, as a share of the largest allowed one."""

    names = ("nav2_route::CostmapScorer",)
    Parameters = CostmapScorerParameters
    parameters: CostmapScorerParameters

    @property
    def costmap_topic(self) -> str:
        """Implement `RouteExtension.costmap_topic`."""
        return self.parameters.costmap_topic

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`; without a costmap each edge is closed."""
        p = self.parameters
        if self.costs is None:
            self.context.warn(f"there is no costmap on '{p.costmap_topic}': all edges are closed")
            return None
        costs = self.costs.along(edge.start.point, edge.end.point, p.check_resolution)
        if costs is None:
            return None if p.invalid_off_map else 0.0
        if p.invalid_on_collision and p.max_cost < NO_INFORMATION and is_blocked(costs, p.max_cost):
            return None
        known = costs[costs != NO_INFORMATION].astype(float)
        if not known.size:
            return 0.0
        return p.weight * float(known.max() if p.use_maximum else np.mean(known)) / p.max_cost
