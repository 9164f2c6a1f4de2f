"""Services that the client offers no longer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rosbridge_library.capabilities.advertise_service import offer_of
from rosbridge_library.capability import Capability, Field

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class UnadvertiseService(Capability):
    """Operation ``unadvertise_service``."""

    fields: tuple[Field, ...] = ((True, "service", str),)
    services_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("unadvertise_service", self.unadvertise_service)

    def unadvertise_service(self, message: dict[str, Any]) -> None:
        """Offer a service no longer."""
        self.basic_type_check(message, self.fields)
        name = message["service"]
        self.check_name(self.services_glob, name)
        services = self.protocol.external_service_list
        offer_of(self.protocol, services, "Service", name).graceful_shutdown()
        del services[name]
