"""Operation that calls a service where the graph asks for it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.errors import OperationFailed
from daidalos.navigation.routes.contracts import Message, OperationResult, Progress, RouteOperation


@dataclass(frozen=True)
class TriggerEventParameters(Parameters):
    """Parameters of the operation, by their Nav2 names."""

    service_name: str = parameter("", "Service of places whose metadata have no service_name.", read_only=True)


class TriggerEvent(RouteOperation):
    """Operation that calls a ``std_srvs/srv/Trigger`` service, such as one that opens a door."""

    names = ("nav2_route::TriggerEvent",)
    Parameters = TriggerEventParameters
    parameters: TriggerEventParameters

    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Implement `RouteOperation.perform`."""
        name = metadata.get("service_name") or self.parameters.service_name
        if not isinstance(name, str) or not name:
            raise OperationFailed(
                f"operation {self.context.name} has no 'service_name', neither as parameter nor in the graph"
            )
        return OperationResult(called=Message(name, "std_srvs/srv/Trigger"))
