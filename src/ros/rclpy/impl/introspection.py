"""Service introspection: events of the requests and responses of a client or a service."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.service_introspection import ServiceIntrospectionState

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.impl.entities import EndpointHandle, PublisherHandle
    from rclpy.qos import QoSProfile


class Introspection:
    """Publisher of the events of one client or service."""

    def __init__(
        self, handle: EndpointHandle, service_type: Any, clock: Clock, qos: QoSProfile, state: ServiceIntrospectionState
    ) -> None:
        from rclpy.impl.entities import PublisherHandle

        self._event = service_type.Event
        self._clock = clock
        self._with_contents = state == ServiceIntrospectionState.CONTENTS
        self._publisher: PublisherHandle = PublisherHandle(
            handle.node, self._event, f"{handle.name}/_service_event", qos
        )

    def publish(
        self, kind: str, client_gid: bytes, sequence_number: int, request: Any = None, response: Any = None
    ) -> None:
        """Publish an event; `kind` is a constant of ``service_msgs/msg/ServiceEventInfo``."""
        from service_msgs.msg import ServiceEventInfo

        publisher = self._publisher.impl
        if not publisher.has_subscribers:
            return
        info = ServiceEventInfo(
            event_type=getattr(ServiceEventInfo, kind),
            stamp=self._clock.now().to_msg(),
            client_gid=list(client_gid),
            sequence_number=sequence_number,
        )
        event = self._event(info=info)
        if self._with_contents:
            event.request = [] if request is None else [request]
            event.response = [] if response is None else [response]
        publisher.publish(event)

    def close(self) -> None:
        """Stop publishing events."""
        self._publisher.destroy_when_not_in_use()
