"""Services that the client offers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from rosbridge_library.capability import Capability, Field
from rosbridge_library.internal.message_conversion import extract_values
from rosbridge_library.internal.ros_loader import get_service_class

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class AdvertisedServiceHandler:
    """Service of the graph whose requests go to a client.

    Parameters
    ----------
    service_name, service_type
        Name and type of the service.
    protocol
        The client.
    """

    def __init__(self, service_name: str, service_type: str, protocol: Protocol) -> None:
        self.request_futures: dict[str, Future] = {}
        self.service_name = service_name
        self.service_type = service_type
        self.protocol = protocol
        self._number = 0
        self.service_handle = protocol.node_handle.create_service(
            get_service_class(service_type),
            service_name,
            self.handle_request,
            callback_group=ReentrantCallbackGroup(),
        )

    def next_id(self) -> int:
        """Return the number of the next request."""
        self._number += 1
        return self._number

    async def handle_request(self, req: Any, res: Any) -> Any:
        """Pass a request to the client and wait for its response."""
        number = f"service_request:{self.service_name}:{self.next_id()}"
        future = self.request_futures[number] = Future(executor=self.protocol.node_handle.executor)
        self.protocol.send(
            {"op": "call_service", "id": number, "service": self.service_name, "args": extract_values(req)}
        )
        try:
            return await future
        finally:
            self.request_futures.pop(number, None)

    def handle_response(self, request_id: str, res: Any) -> None:
        """Answer a request with the client's response."""
        future = self.request_futures.get(request_id)
        if future is None:
            self.protocol.log("warning", f"Received service response for unrecognized id: {request_id}")
        else:
            future.set_result(res)

    def handle_failure(self, request_id: str, reason: str) -> None:
        """Leave a request without an answer, since the client could not carry it out."""
        future = self.request_futures.get(request_id)
        self.protocol.log("warning", f"Service {self.service_name} failed for {request_id}: {reason}")
        if future is not None:
            future.set_exception(self.protocol.abandoned(f"Service {self.service_name} failed: {reason}"))

    def graceful_shutdown(self) -> None:
        """Offer the service no longer; requests under way get no answer."""
        waiting = list(self.request_futures.items())
        if waiting:
            self.protocol.log(
                "warning",
                f"Service {self.service_name} was unadvertised with a service call in progress, "
                f"aborting service calls with request IDs {', '.join(number for number, _ in waiting)}",
            )
        for _, future in waiting:
            future.set_exception(self.protocol.abandoned(f"Service {self.service_name} was unadvertised"))
        self.protocol.node_handle.destroy_service(self.service_handle)


class AdvertiseService(Capability):
    """Operation ``advertise_service``; a service of another client is taken over."""

    advertise_service_msg_fields: tuple[Field, ...] = ((True, "service", str), (True, "type", str))
    services_glob: ClassVar[Sequence[str] | None] = None

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        protocol.register_operation("advertise_service", self.advertise_service)

    def advertise_service(self, message: dict[str, Any]) -> None:
        """Offer a service."""
        self.basic_type_check(message, self.advertise_service_msg_fields)
        name = message["service"]
        self.check_name(self.services_glob, name)
        services = self.protocol.external_service_list
        self.check_room(len(offered_by(self.protocol, services)), "services are offered")
        get_service_class(message["type"])  # before the earlier one ends
        earlier = services.pop(name, None)
        if earlier is not None:
            self.protocol.log("warning", f"Duplicate service advertised. Overwriting {name}.")
            earlier.graceful_shutdown()
        services[name] = AdvertisedServiceHandler(name, message["type"], self.protocol)

    def finish(self) -> None:
        """Offer no more services."""
        for name in offered_by(self.protocol, self.protocol.external_service_list):
            self.protocol.external_service_list.pop(name).graceful_shutdown()
        self.protocol.unregister_operation("advertise_service")


def offered_by(protocol: Protocol, offers: dict[str, Any]) -> list[str]:
    """Return the names of the services, or actions, that a client offers."""
    return [name for name, one in list(offers.items()) if one.protocol is protocol]


def offer_of(protocol: Protocol, offers: dict[str, Any], what: str, name: str) -> Any:
    """Return a service or action that a client offers; raises a LookupError where it offers none of that name."""
    found = offers.get(name)
    if found is None or found.protocol is not protocol:
        raise LookupError(f"{what} {name} has not been advertised by this client")
    return found
