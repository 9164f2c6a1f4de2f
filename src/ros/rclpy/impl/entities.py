"""Handles of nodes and of what nodes hold: the seam between rclpy and the transport."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from types import MethodType
from typing import TYPE_CHECKING, Any, NamedTuple

from daidalos.transport.backend import RequestId
from daidalos.transport.client import Client
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo, names_and_types
from daidalos.transport.publisher import Publisher
from daidalos.transport.qos import Liveliness, Qos
from daidalos.transport.service import Service
from daidalos.transport.session import Session
from daidalos.transport.subscription import Subscription
from rclpy.impl import names
from rclpy.impl.arguments import RosArguments, parse
from rclpy.impl.best_available import best_available_offer, best_available_request
from rclpy.impl.context import ContextHandle
from rclpy.impl.errors import NodeNameNonExistentError, RCLError
from rclpy.impl.handle import Destroyable
from rclpy.impl.introspection import Introspection
from rclpy.impl.log_output import OUTPUT
from rclpy.impl.ready import ReadyNotifier, weakly

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.qos import QoSProfile
    from rclpy.service_introspection import ServiceIntrospectionState


class NodeHandle(Destroyable):
    """A node in the graph, with its names after remapping."""

    def __init__(
        self,
        context: ContextHandle,
        name: str,
        namespace: str,
        arguments: list[str] | None,
        use_global_arguments: bool,
    ) -> None:
        super().__init__()
        self.context = context
        self.session: Session = context.session
        own = parse(["--ros-args", *arguments]) if arguments else RosArguments()
        self.own_arguments = own
        shared_arguments = context.arguments if use_global_arguments else RosArguments()
        self.remaps = [*own.remaps, *shared_arguments.remaps]
        self.parameter_overrides = [*shared_arguments.parameters, *own.parameters]
        self.rosout_enabled = shared_arguments.rosout_logs
        for logger, level in own.log_levels.items():
            OUTPUT.set_level(logger, level)  # type: ignore[arg-type]
        self.original_name = name
        self.namespace = names.remap_namespace(self.remaps, name, names.absolute_namespace(namespace))
        self.name = names.remap_node(self.remaps, name)
        self.info, self._leave = self.session.create_node(self.name, self.namespace, shared_arguments.enclave)
        self._members: weakref.WeakKeyDictionary[EndpointHandle, None] = weakref.WeakKeyDictionary()  # in order
        context.own(self)

    @property
    def graph(self) -> Graph:
        """What is known of the domain."""
        return self.session.graph

    def get_fully_qualified_name(self) -> str:
        """Return the name with its namespace."""
        return self.info.full_name

    def get_node_name(self) -> str:
        """Return the name."""
        return self.name

    def get_namespace(self) -> str:
        """Return the namespace."""
        return self.namespace

    def logger_name(self) -> str:
        """Return the name that the node logs under: ``namespace.name``."""
        return ".".join(part for part in self.info.full_name.split("/") if part)

    def resolve_name(self, name: str, *, is_service: bool = False, only_expand: bool = False) -> str:
        """Return the full name of a topic or service of the node, remapped unless `only_expand`."""
        full = names.expand(name, self.name, self.namespace)
        if only_expand:
            return full
        kind = "service" if is_service else "topic"
        return names.remap_name(self.remaps, kind, full, self.name, self.namespace)

    def check_context(self) -> None:
        """Check that endpoints can still be made.

        Raises
        ------
        RCLError
            When the context was shut down.
        """
        if self.context.is_released:
            raise RCLError(f"node '{self.info.full_name}' cannot make anything: its context was shut down")

    def own(self, handle: EndpointHandle) -> None:
        """Register a handle, whose endpoint exists, that is destroyed with the node.

        Raises
        ------
        RCLError
            When the context was shut down meanwhile.
        """
        self.check_context()
        self._members[handle] = None

    def retire(self) -> None:
        """Leave the graph with everything of the node, because the context ended; handles stay, and reach nobody."""
        for member in list(self._members):
            member.retire()
        self._leave()

    def find_node(self, name: str, namespace: str) -> NodeInfo:
        """Return the description of a node in the graph.

        Raises
        ------
        NodeNameNonExistentError
            When there is none of that name.
        """
        found = self.graph.find_nodes(name, namespace)
        if not found:
            raise NodeNameNonExistentError(
                f"cannot get information of node '{namespace.rstrip('/')}/{name}': it does not exist"
            )
        return found[0]

    def names_and_types_of(self, name: str, namespace: str, kind: EndpointKind) -> list[tuple[str, list[str]]]:
        """Return what endpoints of a kind a node in the graph has."""
        return names_and_types(self.graph.endpoints_of(self.find_node(name, namespace), kind))

    def _destroy(self) -> None:
        for member in list(self._members):
            member.destroy_when_not_in_use()
        self._leave()

    def __del__(self) -> None:
        if hasattr(self, "_leave") and not self.is_destroyed:
            self.session.abandon(self._leave)


class RequestHeader(NamedTuple):
    """Header that identifies a request; `identity` is the transport's, None in a client."""

    sequence_number: int
    identity: RequestId | None


class ServiceInfo(NamedTuple):
    """The header of a request or a response; stamps are Unix time in nanoseconds."""

    request_id: RequestHeader
    source_timestamp: int
    received_timestamp: int


class EndpointHandle(Destroyable):
    """Base of the four kinds of endpoints.

    Parameters
    ----------
    node
        The node that the endpoint belongs to.
    create
        Creates the transport's object. The node knows the handle only afterwards: a creation that fails or is
        interrupted leaves nothing behind that the node would destroy.

    Attributes
    ----------
    impl
        The transport's object.

    Raises
    ------
    RCLError
        When the context of the node was shut down.
    """

    impl: Publisher | Subscription | Service | Client

    def __init__(self, node: NodeHandle, create: Callable[[], Any]) -> None:
        super().__init__()
        self.node = node
        node.check_context()
        self.impl = create()
        node.own(self)

    @property
    def endpoint(self) -> EndpointInfo:
        """The endpoint as the graph knows it."""
        return self.impl.endpoint

    @property
    def name(self) -> str:
        """The full name of the topic or service."""
        return self.endpoint.name

    def retire(self) -> None:
        """Leave the graph; the handle stays, and reaches nobody."""
        self.impl.close()

    def _destroy(self) -> None:
        self.impl.close()

    def __del__(self) -> None:
        if hasattr(self, "impl") and not self.is_destroyed:
            self.node.session.abandon(self.impl.close)


class QueueHandle(ReadyNotifier, EndpointHandle):
    """Base of the endpoints with a queue of what came in."""

    impl: Subscription | Service | Client
    _stop_new: Callable[[], None] | None = None

    def set_on_ready(self, on_ready: Callable[[], None]) -> None:
        """Call `on_ready` when something was queued, and at once if something is.

        A bound method does not keep its object alive.
        """
        self.announce_to(weakly(on_ready) if isinstance(on_ready, MethodType) else on_ready)
        if len(self.impl):
            on_ready()

    def _wire(self, call: Callable[[], None]) -> None:
        self.impl.on_ready = call

    def _set_on_new(self, callback: Callable[[int], None]) -> None:
        """Call ``callback(count)`` when something was queued, and at once if something is."""
        self._clear_on_new()
        self._stop_new = self.listen(lambda: callback(1))
        if len(self.impl):
            callback(len(self.impl))

    def _clear_on_new(self) -> None:
        stop, self._stop_new = self._stop_new, None
        if stop is not None:
            stop()


class ServiceEndHandle(QueueHandle):
    """Base of clients and services."""

    impl: Service | Client
    introspection: Introspection | None = None

    def configure_introspection(
        self, clock: Clock, service_type: Any, qos: QoSProfile, state: ServiceIntrospectionState
    ) -> None:
        """Publish events of requests and responses from now on.

        Parameters
        ----------
        clock
            Stamps the events.
        service_type
            The class of the service.
        qos
            Quality of service of the topic of the events.
        state
            Whether events are published, and whether with the messages.
        """
        before, self.introspection = self.introspection, None
        if before is not None:
            before.close()
        if state:
            self.introspection = Introspection(self, service_type, clock, qos, state)


def liveliness_topic(topic: str) -> str:
    """Return the hidden topic on which manual publishers of `topic` assert their liveliness."""
    return f"{topic}/_liveliness"


class PublisherHandle(EndpointHandle):
    """A publisher."""

    impl: Publisher
    _liveliness: Publisher | None = None

    def __init__(self, node: NodeHandle, message_type: Any, topic: str, qos: QoSProfile) -> None:
        resolved = best_available_offer(qos, node.graph, topic).resolved()
        super().__init__(node, lambda: node.session.create_publisher(node.info, topic, message_type, resolved))

    def get_topic_name(self) -> str:
        """Return the full topic name."""
        return self.name

    @property
    def has_subscribers(self) -> bool:
        """Whether a message would reach, or be kept for, anybody."""
        return self.impl.has_subscribers

    def assert_liveliness(self) -> None:
        """Assert that the publisher is alive, though it publishes nothing."""
        if self.endpoint.qos.liveliness is not Liveliness.MANUAL_BY_TOPIC:
            return
        from rmw_dds_common.msg import Gid

        if self._liveliness is None:
            self._liveliness = self.node.session.create_publisher(
                self.node.info, liveliness_topic(self.name), Gid, Qos()
            )
        self.impl.note()
        self._liveliness.publish(Gid(data=list(self.endpoint.gid)))

    def retire(self) -> None:
        """Leave the graph; the handle stays, and reaches nobody."""
        super().retire()
        if self._liveliness is not None:
            self._liveliness.close()

    def _destroy(self) -> None:
        self.retire()

    def get_subscription_count(self) -> int:
        """Return how many subscriptions get the samples."""
        return len(self.node.session.matching_endpoints(self.endpoint))


class SubscriptionHandle(QueueHandle):
    """A subscription."""

    impl: Subscription

    def __init__(self, node: NodeHandle, message_type: Any, topic: str, qos: QoSProfile) -> None:
        resolved = best_available_request(qos, node.graph, topic).resolved()
        super().__init__(node, lambda: node.session.create_subscription(node.info, topic, message_type, resolved))

    def get_topic_name(self) -> str:
        """Return the full topic name."""
        return self.name

    def get_publisher_count(self) -> int:
        """Return how many publishers send samples here."""
        return len(self.node.session.matching_endpoints(self.endpoint))

    def set_sink(self, sink: Callable[[Any], None]) -> None:
        """Call a method, which does not keep its object alive, with every message on the thread that receives it.

        Nothing is queued any more. The method must not change the messages, which other sinks get as well.
        """
        self.impl.drain_into(weakly(sink))

    def take_message(self, message_type: Any, raw: bool = False) -> tuple[Any, dict[str, Any]] | None:
        """Return the oldest message, or its CDR bytes, with what is known of it; None when there is none."""
        taken = self.impl.take_raw() if raw else self.impl.take()
        if taken is None:
            return None
        info = self.impl.info(taken[1])
        return taken[0], {"source_timestamp": info.source_ns, "received_timestamp": info.received_ns}

    def set_on_new_message_callback(self, callback: Callable[[int], None]) -> None:
        """Call ``callback(count)`` when messages came, on the thread that receives them."""
        self._set_on_new(callback)

    def clear_on_new_message_callback(self) -> None:
        """Remove the callback."""
        self._clear_on_new()


class ServiceHandle(ServiceEndHandle):
    """A service."""

    impl: Service

    def __init__(self, node: NodeHandle, service_type: Any, name: str, qos: QoSProfile) -> None:
        super().__init__(node, lambda: node.session.create_service(node.info, name, service_type, qos.resolved()))

    def take_request(self) -> tuple[Any, ServiceInfo] | None:
        """Return the oldest request with its header, or None."""
        taken = self.impl.take()
        if taken is None:
            return None
        request, identity, source_ns, received_ns = taken
        if self.introspection is not None:
            self.introspection.publish("REQUEST_RECEIVED", identity.client, identity.sequence, request=request)
        return request, ServiceInfo(RequestHeader(identity.sequence, identity), source_ns, received_ns)

    def service_take_request(self, request_type: Any) -> tuple[Any, Any]:
        """Return the oldest request with its header, or (None, None)."""
        return self.take_request() or (None, None)

    def set_on_new_request_callback(self, callback: Callable[[int], None]) -> None:
        """Call ``callback(count)`` when requests came, on the thread that receives them."""
        self._set_on_new(callback)

    def clear_on_new_request_callback(self) -> None:
        """Remove the callback."""
        self._clear_on_new()

    def send_response(self, response: Any, header: Any) -> None:
        """Send the response to a request; `header` is what `take_request` returned, or its `request_id`."""
        identity = getattr(header, "request_id", header).identity
        if self.introspection is not None:
            self.introspection.publish("RESPONSE_SENT", identity.client, identity.sequence, response=response)
        self.impl.reply(identity, response)


class ClientHandle(ServiceEndHandle):
    """A client."""

    impl: Client

    def __init__(self, node: NodeHandle, service_type: Any, name: str, qos: QoSProfile) -> None:
        super().__init__(node, lambda: node.session.create_client(node.info, name, service_type, qos.resolved()))

    def send_request(self, request: Any) -> int:
        """Send a request, and return its sequence number."""
        number = self.impl.send(request)
        if self.introspection is not None:
            self.introspection.publish("REQUEST_SENT", self.endpoint.gid, number, request=request)
        return number

    def set_on_new_response_callback(self, callback: Callable[[int], None]) -> None:
        """Call ``callback(count)`` when responses came, on the thread that receives them."""
        self._set_on_new(callback)

    def clear_on_new_response_callback(self) -> None:
        """Remove the callback."""
        self._clear_on_new()

    def take_response(self, response_type: Any = None) -> tuple[ServiceInfo, Any] | None:
        """Return the oldest response with its header, or None."""
        taken = self.impl.take()
        if taken is None:
            return None
        response, number, source_ns, received_ns = taken
        if self.introspection is not None:
            self.introspection.publish("RESPONSE_RECEIVED", self.endpoint.gid, number, response=response)
        return ServiceInfo(RequestHeader(number, None), source_ns, received_ns), response

    def service_server_is_available(self) -> bool:
        """Return whether somebody serves the service."""
        return self.node.session.server_is_ready(self.impl)


class GuardConditionHandle(ReadyNotifier, Destroyable):
    """A flag that wakes an executor."""

    def __init__(self, context: ContextHandle, on_ready: Callable[[], None]) -> None:
        super().__init__()
        self.context = context
        self._triggered = False
        self.announce_to(on_ready)

    def _wire(self, call: Callable[[], None]) -> None:
        self._on_ready = call

    def trigger_guard_condition(self) -> None:
        """Wake the executor."""
        self._triggered = True
        self._on_ready()

    def take_trigger(self) -> bool:
        """Return whether it was triggered since the last call."""
        triggered, self._triggered = self._triggered, False
        return triggered
