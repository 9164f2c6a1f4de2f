"""Operation that measures the time on edges."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import NOTHING, ON_STATUS_CHANGE, OperationResult, Progress, RouteOperation
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class TimeMarkerParameters(Parameters):
    """Parameters of the operation, by their Nav2 names."""

    time_tag: str = parameter("abs_time_taken", "Metadata in which the time is kept.", not_empty=True)


class TimeMarker(RouteOperation):
    """Operation that keeps the time [s] that each edge took in the metadata of the edge."""

    names = ("nav2_route::TimeMarker",)
    Parameters = TimeMarkerParameters
    parameters: TimeMarkerParameters
    occasion = ON_STATUS_CHANGE
    _edge: GraphEdge | None = None
    _entered = 0.0

    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Implement `RouteOperation.perform`."""
        if progress.left is not None and progress.left is self._edge and now > self._entered:
            progress.left.metadata[self.parameters.time_tag] = now - self._entered
        self._edge, self._entered = progress.edge, now
        return NOTHING
