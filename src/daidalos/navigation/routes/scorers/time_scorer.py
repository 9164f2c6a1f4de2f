"""Scorer of the time on edges."""

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class TimeScorerParameters(Parameters):
    """Parameters of the scorer, by their Nav2 names."""

    weight: float = parameter(1.0, "Factor of the cost.", minimum=0.0)
    speed_tag: str = parameter("abs_speed_limit", "Metadata with the speed limit [m/s].", not_empty=True)
    time_tag: str = parameter("abs_time_taken", "Metadata with the time [s] that was measured.", not_empty=True)
    max_vel: float = parameter(0.5, "Speed on edges without a limit.", unit="m/s", above=0.0)


class TimeScorer(EdgeScorer):
    """Scorer of the time that an edge took when it was last driven, or would take at its speed limit."""

    names = ("nav2_route::TimeScorer",)
    Parameters = TimeScorerParameters
    parameters: TimeScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        p = self.parameters
        measured = edge.number(p.time_tag, 0.0)
        if measured > 0.0:
            return p.weight * measured
        speed = edge.number(p.speed_tag, 0.0)
        return p.weight * edge.length / (speed if speed > 0.0 else p.max_vel)
