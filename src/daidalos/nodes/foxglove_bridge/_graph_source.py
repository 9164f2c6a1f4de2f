"""The ROS graph for the studio's server, read through a node."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from functools import cache
from typing import Any

from rclpy.exceptions import InvalidTopicNameException
from rclpy.impl.entities import PublisherHandle, SubscriptionHandle
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.validate_full_topic_name import validate_full_topic_name
from rosidl_runtime_py.get_interfaces import interface_library
from rosidl_runtime_py.utilities import get_message, get_service

from daidalos.interfaces.schema import message_schema
from daidalos.nodes.foxglove_bridge._endpoints import DEPTH, Caller, Closing, Publication, matching_qos
from daidalos.nodes.graph_parameters import GraphParameters
from daidalos.studio.source import (
    Graph,
    MessageCallback,
    Observer,
    Parameter,
    Service,
    SourceError,
    Topic,
)
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo

_CLOCK = "/clock"
_TYPE_NAME = re.compile(r"[A-Za-z]\w*/(msg|srv|action)/[A-Za-z]\w*")
_MAX_SHOWN = 100
"""Number of characters of a client's text that a message repeats."""


class RosGraphSource:
    """ROS graph for the studio; see `daidalos.studio.source.GraphSource`. The node must be spun.

    Parameters
    ----------
    node : Node
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._handle = node.handle
        self._graph = node.handle.graph
        self._parameters = GraphParameters(node)
        self._callers: dict[tuple[str, str], Caller] = {}
        self._clock: SubscriptionHandle | None = None
        self._time: int | None = None
        self._observers: list[Observer] = []
        self._lock = threading.Lock()
        self._clock_found = node.create_guard_condition(self._subscribe_to_clock)

    # Changes.

    def attach(self, observer: Observer) -> Closing:
        """Call an observer at changes of the graph and of simulated time."""
        self._observers.append(observer)

        def note(added: bool, what: NodeInfo | EndpointInfo) -> None:
            if added and self._clock is None and what.name == _CLOCK:
                self._clock_found.trigger()
            observer.graph_changed()

        stop = self._graph.listen(note)
        self._clock_found.trigger()

        def close() -> None:
            stop()
            if observer in self._observers:
                self._observers.remove(observer)

        return Closing(close)

    def _subscribe_to_clock(self) -> None:
        """Subscribe to the clock once it is published: an earlier subscription would create the topic."""
        if self._clock is not None or not self._graph.endpoints(EndpointKind.PUBLISHER, name=_CLOCK):
            return
        from rosgraph_msgs.msg import Clock

        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock = SubscriptionHandle(self._handle, Clock, _CLOCK, qos)
        self._clock.set_sink(self._on_clock)

    def _on_clock(self, message: Any) -> None:
        clock = message.clock
        self._time = clock.sec * 1_000_000_000 + clock.nanosec
        for observer in self._observers:
            observer.time_advanced(self._time)

    def time(self) -> int | None:
        """Return simulated time [ns], None if it is not published."""
        return self._time

    # What there is.

    def topics(self) -> list[Topic]:
        """List every topic, once for each of its types."""
        found: dict[tuple[str, str], bool] = {}
        for endpoint in self._graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
            key = (endpoint.name, endpoint.type_name)
            latched = endpoint.kind is EndpointKind.PUBLISHER and endpoint.qos.transient_local
            found[key] = found.get(key, False) or latched
        return [Topic(name, kind, _schema(kind), latched) for (name, kind), latched in sorted(found.items())]

    def services(self) -> list[Service]:
        """List every service whose type is known."""
        found: dict[str, str] = {}
        for endpoint in self._graph.endpoints(EndpointKind.SERVICE):
            # Clients call by name: of several types of one name, the one that `call` uses is listed.
            found[endpoint.name] = min(endpoint.type_name, found.get(endpoint.name, endpoint.type_name))
        result = []
        for name, kind in sorted(found.items()):
            request, response = _schema(f"{kind}_Request"), _schema(f"{kind}_Response")
            if request is not None and response is not None:
                result.append(Service(name, kind, request, response))
        return result

    def graph(self) -> Graph:
        """Return the nodes that publish, subscribe and serve."""
        kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVICE)
        sides: dict[EndpointKind, dict[str, set[str]]] = {kind: {} for kind in kinds}
        for endpoint in self._graph.endpoints(*kinds):
            sides[endpoint.kind].setdefault(endpoint.name, set()).add(endpoint.node.full_name)
        frozen = [{name: frozenset(nodes) for name, nodes in sides[kind].items()} for kind in kinds]
        return Graph(*frozen)

    # Messages.

    def subscribe(self, topic: Topic, received: MessageCallback) -> Closing:
        """Subscribe to a topic; messages are passed on in the thread that receives them."""
        kind = _class_of(get_message, topic.type)
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=topic.name)
        handle = SubscriptionHandle(self._handle, kind, topic.name, matching_qos(publishers))
        impl = handle.impl
        closed = threading.Event()

        def forward() -> None:
            taken = impl.take_raw()
            while taken is not None and not closed.is_set():
                # Where time is simulated, that is when a message came.
                stamp = impl.info(taken[1]).received_ns if self._time is None else self._time
                received(stamp, taken[0])
                taken = impl.take_raw()

        handle.set_on_ready(forward)

        def close() -> None:
            closed.set()
            handle.destroy_when_not_in_use()

        return Closing(close)

    def advertise(self, topic: str, type_name: str) -> Publication:
        """Advertise a topic for a client."""
        try:
            validate_full_topic_name(topic)
        except InvalidTopicNameException as error:
            raise SourceError(str(error)) from None
        return Publication(
            PublisherHandle(self._handle, _class_of(get_message, type_name), topic, QoSProfile(depth=DEPTH))
        )

    def call(self, service: str, request: bytes) -> Future[bytes]:
        """Call a service."""
        answer: Future[bytes] = Future()
        servers = self._graph.endpoints(EndpointKind.SERVICE, name=service)
        if not servers:
            answer.set_exception(SourceError(f"nobody serves {service}"))
            return answer
        type_name = min(server.type_name for server in servers)
        try:
            with self._lock:
                caller = self._callers.get((service, type_name))
                if caller is None:
                    kind = _class_of(get_service, type_name)
                    caller = self._callers[service, type_name] = Caller(self._handle, kind, service)
            caller.call(request, answer)
        except (SourceError, ValueError) as error:
            answer.set_exception(SourceError(str(error)))
        return answer

    # Parameters.

    def get_parameters(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        """Read parameters, named ``/node.parameter``; all of them where none is named."""
        return self._parameters.get(names)

    def set_parameters(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        """Set parameters and read them again."""
        return self._parameters.set(parameters)

    def close(self) -> None:
        """Close what was opened for the clock and for calls."""
        for caller in self._callers.values():
            caller.close()
        clock, self._clock = self._clock, None
        if clock is not None:
            clock.destroy_when_not_in_use()


def _class_of(find: Callable[[str], Any], type_name: str) -> Any:
    """Return the class of an interface; a name that no interface has is never imported."""
    if not _TYPE_NAME.fullmatch(type_name) or not (_schema(type_name) or _schema(f"{type_name}_Request")):
        raise SourceError(f"the type {type_name[:_MAX_SHOWN]} is not known here")
    try:
        return find(type_name)
    except (ImportError, AttributeError, ValueError) as error:
        raise SourceError(f"the type {type_name} is not known here: {error}") from None


@cache
def _schema(type_name: str) -> str | None:
    """Return the definition of a type with its dependencies, None if unknown."""
    try:
        return message_schema(type_name, interface_library())
    except (LookupError, ValueError, KeyError):
        return None
