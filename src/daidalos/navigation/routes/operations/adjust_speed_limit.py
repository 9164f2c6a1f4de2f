"""Operation that limits the speed on edges."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.routes.contracts import (
    NOTHING,
    ON_STATUS_CHANGE,
    Message,
    OperationResult,
    Progress,
    RouteOperation,
)


@dataclass(frozen=True)
class AdjustSpeedLimitParameters(Parameters):
    """Parameters of the operation, by their Nav2 names."""

    speed_tag: str = parameter("speed_limit", "Metadata with the limit in percent.", not_empty=True)
    speed_limit_topic: str = parameter("speed_limit", "Topic of the limits.", not_empty=True, read_only=True)


class AdjustSpeedLimit(RouteOperation):
    """Operation that publishes the speed limit of each edge that is entered, in percent; 100 where it has none."""

    names = ("nav2_route::AdjustSpeedLimit",)
    Parameters = AdjustSpeedLimitParameters
    parameters: AdjustSpeedLimitParameters
    occasion = ON_STATUS_CHANGE

    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Implement `RouteOperation.perform`."""
        p = self.parameters
        if progress.edge is None:
            return NOTHING
        fields = {"percentage": True, "speed_limit": progress.edge.number(p.speed_tag, 100.0)}
        return OperationResult(published=(Message(p.speed_limit_topic, "nav2_msgs/msg/SpeedLimit", fields),))
