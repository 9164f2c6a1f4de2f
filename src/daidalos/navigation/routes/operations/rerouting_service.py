"""Operation that asks for another route when a service is called."""

from collections.abc import Mapping
from typing import Any

from daidalos.navigation.routes.contracts import (
    NOTHING,
    ON_QUERY,
    OperationResult,
    Progress,
    RouteOperation,
    ServiceOffer,
)


class ReroutingService(RouteOperation):
    """Operation with a service that asks for another route."""

    names = ("nav2_route::ReroutingService",)
    occasion = ON_QUERY
    _is_asked_for = False

    @property
    def services(self) -> tuple[ServiceOffer, ...]:
        """Implement `RouteExtension.services`."""
        return (ServiceOffer("reroute", "std_srvs/srv/Trigger", self.ask),)

    def ask(self, request: Any) -> None:
        """Ask for another route."""
        self._is_asked_for = True

    def perform(self, progress: Progress, now: float, metadata: Mapping[str, Any]) -> OperationResult:
        """Implement `RouteOperation.perform`."""
        if not self._is_asked_for:
            return NOTHING
        self._is_asked_for = False
        return OperationResult(reroute=True)
