"""Operation that looks for obstacles on the route ahead."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.errors import OperationFailed
from daidalos.navigation.routes.contracts import NOTHING, ON_QUERY, OperationResult, Progress, RouteOperation
from daidalos.navigation.routes.costs import RouteCosts, is_blocked
from daidalos.navigation.routes.graph import GraphEdge, closest_point


@dataclass(frozen=True)
class CollisionMonitorParameters(Parameters):
    """Parameters of the operation, by their Nav2 names."""

    costmap_topic: str = parameter("local_costmap/costmap_raw", "Topic of the costmap.", not_empty=True, read_only=True)
    rate: float = parameter(1.0, "Checks per second.", unit="Hz", above=0.0)
    max_cost: float = parameter(253.0, "Cost from which on an edge is blocked.", above=0.0, maximum=254.0)
    max_collision_dist: float = parameter(5.0, "How far ahead it looks; 0 or less: to the end.", unit="m")
    check_resolution: int = parameter(
        1, "Looks at every cell where 1, at every other where 2.", unit="cells", minimum=1
    )
    reroute_on_collision: bool = parameter(True, "Whether another route is searched, rather than given up.")


class CollisionMonitor(RouteOperation):
    """Operation that asks for another route, or fails, where the costmap shows the route ahead as blocked."""

    names = ("nav2_route::CollisionMonitor",)
    Parameters = CollisionMonitorParameters
    parameters: CollisionMonitorParameters
    occasion = ON_QUERY

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._checked = -math.inf

    @property
    def costmap_topic(self) -> str:
        """Implement `RouteExtension.costmap_topic`."""
        return self.parameters.costmap_topic

    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Implement `RouteOperation.perform`."""
        p = self.parameters
        is_due = not 0.0 <= now - self._checked < 1.0 / p.rate  # also after the clock was set back
        if not is_due or progress.edge is None:
            return NOTHING
        self._checked = now
        if self.costs is None:
            raise OperationFailed(f"the route cannot be checked: there is no costmap on '{p.costmap_topic}'")
        blocked = self._blocked(progress, self.costs)
        if blocked is None:
            return NOTHING
        if not p.reroute_on_collision:
            raise OperationFailed(f"edge {blocked.id} of the route is blocked")
        return OperationResult(reroute=True, blocked=(blocked.id,))

    def _blocked(self, progress: Progress, view: RouteCosts) -> GraphEdge | None:
        """Return the first blocked edge ahead within the distance."""
        p, edge = self.parameters, progress.edge
        assert edge is not None
        left = p.max_collision_dist if p.max_collision_dist > 0.0 else math.inf
        edges = progress.route.edges
        rest = edges[edges.index(edge) + 1 :] if edge in edges else edges
        start = closest_point(progress.pose, edge.start.point, edge.end.point)
        for one in (edge, *rest):
            end, length = one.end.point, float(np.hypot(*(one.end.point - start)))
            if length > left:
                end = start + (left / length) * (end - start)
            inside = view.inside(start, end)
            if inside is None:
                return None
            costs = view.along(start, inside, p.check_resolution)
            if costs is not None and is_blocked(costs, p.max_cost):
                return one
            left -= length
            if left <= 0.0 or inside is not end:
                return None
            start = one.end.point
        return None
