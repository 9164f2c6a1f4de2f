"""The ROS graph for the studio's server, read through a node."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from functools import cache
from typing import Any

from rclpy.impl.entities import ClientHandle, PublisherHandle, SubscriptionHandle
from rclpy.node import Node
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosidl_runtime_py.get_interfaces import interface_library
from rosidl_runtime_py.utilities import get_message, get_service

from daidalos.interfaces.codec import codec_of
from daidalos.interfaces.schema import message_schema
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

_DEPTH = 10
_CLOCK = "/clock"


class RosGraphSource:
    """ROS graph for the studio; see `daidalos.studio.source.GraphSource`. The node must be spun.

    Parameters
    ----------
    node : Node
    answered : callable
        Called with every response to a client's call, before the client gets it.
    """

    def __init__(self, node: Node, answered: Callable[[Any], None] = lambda response: None) -> None:
        self._node = node
        self._answered = answered
        self._handle = node.handle
        self._graph = node.handle.graph
        self._clients: dict[str, AsyncParameterClient] = {}
        self._callers: dict[tuple[str, str], _Caller] = {}
        self._clock: SubscriptionHandle | None = None
        self._time: int | None = None
        self._observers: list[Observer] = []
        self._lock = threading.Lock()
        self._clock_found = node.create_guard_condition(self._subscribe_to_clock)

    # Changes.

    def attach(self, observer: Observer) -> _Closing:
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

        return _Closing(close)

    def _subscribe_to_clock(self) -> None:
        """Subscribe to the clock once it is published: an earlier subscription would create the topic."""
        if self._clock is not None or not self._graph.endpoints(EndpointKind.PUBLISHER, name=_CLOCK):
            return
        from rosgraph_msgs.msg import Clock

        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock = SubscriptionHandle(self._handle, Clock, _CLOCK, qos)
        self._clock.set_on_ready(self._on_clock)

    def _on_clock(self) -> None:
        taken = self._clock.impl.take() if self._clock is not None else None
        if taken is None:
            return
        clock = taken[0].clock
        self._time = clock.sec * 1_000_000_000 + clock.nanosec
        for observer in self._observers:
            observer.time_advanced(self._time)

    def time(self) -> int | None:
        """Return simulated time in ns, None where nobody publishes it."""
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

    def subscribe(self, topic: Topic, received: MessageCallback) -> _Closing:
        """Subscribe to a topic; messages are passed on in the thread that receives them."""
        kind = _class_of(get_message, topic.type)
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=topic.name)
        handle = SubscriptionHandle(self._handle, kind, topic.name, _matching_qos(publishers))
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

        return _Closing(close)

    def advertise(self, topic: str, type_name: str) -> _Publication:
        """Advertise a topic for a client."""
        return _Publication(
            PublisherHandle(self._handle, _class_of(get_message, type_name), topic, QoSProfile(depth=_DEPTH))
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
                    caller = self._callers[service, type_name] = _Caller(self._handle, kind, service, self._answered)
            caller.call(request, answer)
        except (SourceError, ValueError) as error:
            answer.set_exception(SourceError(str(error)))
        return answer

    # Parameters.

    def get_parameters(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        """Read parameters, named ``/node.parameter``; all of them where none is named."""
        return self._gather(
            _by_node(names) if names else {node.full_name: [] for node in self._graph.nodes()}, self._read
        )

    def set_parameters(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        """Set parameters and read them again."""
        values = {parameter.name: parameter.value for parameter in parameters}

        async def write(client: AsyncParameterClient, node: str, names: list[str]) -> list[Parameter]:
            wanted: list[Any] = [RclpyParameter(name, value=values[f"{node}.{name}"]) for name in names]
            await client.set_parameters(wanted)
            return await self._read(client, node, names)

        return self._gather(_by_node(list(values)), write)

    def _gather(self, wanted: dict[str, list[str]], work: Callable[..., Any]) -> Future[Sequence[Parameter]]:
        """Do some work with the parameters of every node, in the node's executor."""
        answer: Future[Sequence[Parameter]] = Future()
        executor = self._node.executor
        if executor is None:
            answer.set_exception(SourceError("the bridge is not running"))
            return answer

        async def gather() -> None:
            found: list[Parameter] = []
            for node, names in wanted.items():
                client = self._client_of(node)
                if client.services_are_ready():
                    found += await work(client, node, names)
            if answer.set_running_or_notify_cancel():  # the client may be gone
                answer.set_result(found)

        executor.create_task(gather)
        return answer

    def _client_of(self, node: str) -> AsyncParameterClient:
        if node not in self._clients:
            self._clients[node] = AsyncParameterClient(self._node, node)
        return self._clients[node]

    async def _read(self, client: AsyncParameterClient, node: str, names: list[str]) -> list[Parameter]:
        if not names:
            names = list((await client.list_parameters()).result.names)
        values = (await client.get_parameters(names)).values
        return [
            Parameter(f"{node}.{name}", parameter_value_to_python(value))
            for name, value in zip(names, values, strict=False)
        ]

    def close(self) -> None:
        """Close what was opened for the clock and for calls."""
        for caller in self._callers.values():
            caller.close()
        clock, self._clock = self._clock, None
        if clock is not None:
            clock.destroy_when_not_in_use()


class _Closing:
    """An opened resource; closing it twice is harmless."""

    def __init__(self, close: Callable[[], None]) -> None:
        self._close: Callable[[], None] | None = close

    def close(self) -> None:
        """Close it."""
        close, self._close = self._close, None
        if close is not None:
            close()


class _Publication(_Closing):
    """Topic that is published for a client."""

    def __init__(self, handle: PublisherHandle) -> None:
        super().__init__(handle.destroy_when_not_in_use)
        self._impl = handle.impl

    def publish(self, payload: bytes) -> None:
        """Send one message."""
        self._impl.publish(payload)


class _Caller:
    """Client of one service with serialized messages."""

    def __init__(self, node: Any, kind: Any, name: str, answered: Callable[[Any], None]) -> None:
        self._answered = answered
        self._handle = ClientHandle(node, kind, name, QoSProfile(depth=_DEPTH))
        self._request = codec_of(kind.Request)
        self._response = codec_of(kind.Response)
        self._waiting: dict[int, Future[bytes]] = {}
        self._lock = threading.Lock()
        self._handle.set_on_ready(self._on_ready)

    def call(self, request: bytes, answer: Future[bytes]) -> None:
        """Send a request; `answer` gets the response."""
        with self._lock:
            self._waiting[self._handle.send_request(self._request.decode(request))] = answer

    def _on_ready(self) -> None:
        taken = self._handle.take_response()
        while taken is not None:
            header, response = taken
            with self._lock:
                answer = self._waiting.pop(header.request_id.sequence_number, None)
            if answer is not None:
                self._answered(response)
                if answer.set_running_or_notify_cancel():  # the client may be gone
                    answer.set_result(self._response.encode(response))
            taken = self._handle.take_response()

    def close(self) -> None:
        """Close the client; calls that wait get no answer."""
        self._handle.destroy_when_not_in_use()


def _by_node(names: Sequence[str]) -> dict[str, list[str]]:
    """Group ``/node.parameter`` names by node."""
    found: dict[str, list[str]] = {}
    for name in names:
        node, _, parameter = name.partition(".")
        found.setdefault(node, []).append(parameter)
    return found


def _matching_qos(publishers: list[EndpointInfo]) -> QoSProfile:
    """Return a profile that every publisher satisfies."""
    reliable = bool(publishers) and all(one.qos.reliable for one in publishers)
    latched = bool(publishers) and all(one.qos.transient_local for one in publishers)
    return QoSProfile(
        depth=max([_DEPTH, *(min(one.qos.depth, 100) for one in publishers)]),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def _class_of(find: Callable[[str], Any], type_name: str) -> Any:
    try:
        return find(type_name)
    except (ImportError, AttributeError, ValueError) as error:
        raise SourceError(f"the type {type_name} is not known here: {error}") from None


@cache
def _schema(type_name: str) -> str | None:
    """Return the definition of a type with its dependencies, None where nobody knows it."""
    try:
        return message_schema(type_name, interface_library())
    except (LookupError, ValueError, KeyError):
        return None
