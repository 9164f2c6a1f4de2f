"""Responses of services that the client offers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosbridge_library.capabilities.advertise_service import offer_of
from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.message_conversion import populate_instance
from rosbridge_library.internal.ros_loader import get_service_response_instance

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class ServiceResponse(Capability):
    """Operation ``service_response``."""

    service_response_msg_fields: tuple[Field, ...] = (
        (True, "service", str),
        (False, "id", str),
        (False, "values", (dict, str)),
        (True, "result", bool),
    )

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("service_response", self.service_response)

    def service_response(self, message: dict[str, Any]) -> None:
        """Answer a request; with ``result`` false, whoever called gets no answer."""
        self.basic_type_check(message, self.service_response_msg_fields)
        handler = offer_of(self.protocol, self.protocol.external_service_list, "Service", message["service"])
        number, values = message.get("id", ""), message.get("values", {})
        if not message["result"] or isinstance(values, str):
            handler.handle_failure(number, str(values))
            return
        handler.handle_response(number, populate_instance(values, get_service_response_instance(handler.service_type)))
