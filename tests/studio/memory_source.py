"""A ROS graph in memory, for the server's tests: real CDR bytes, latched topics, services, parameters."""

import threading
from collections import defaultdict, deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from daidalos.studio.source import Graph, Parameter, Service, SourceError, Topic

STORE = get_typestore(Stores.ROS2_JAZZY)
STORE.register(
    get_types_from_msg(
        "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data\n",
        "map_msgs/msg/OccupancyGridUpdate",
    )
)


def schema(type_name: str) -> str:
    """The definition of a type with its dependencies, as Foxglove's clients expect it."""
    return STORE.generate_msgdef(type_name, ros_version=2)[0]


def make(type_name: str, **fields: Any) -> Any:
    """Build a message of rosbags' types."""
    return STORE.types[type_name](**fields)


def encode(type_name: str, message: Any) -> bytes:
    return bytes(STORE.serialize_cdr(message, type_name))


def decode(type_name: str, payload: bytes) -> Any:
    return STORE.deserialize_cdr(payload, type_name)


@dataclass
class _Subscription:
    source: "MemorySource"
    topic: str
    received: Callable[[int, bytes], None]

    def close(self) -> None:
        self.source.drop(self)


@dataclass
class _Publication:
    source: "MemorySource"
    topic: str
    type: str

    def publish(self, payload: bytes) -> None:
        self.source.published.append((self.topic, self.type, payload))
        self.source.send(self.topic, payload)
        hook = self.source.hooks.get(self.topic)
        if hook is not None:
            hook(payload)

    def close(self) -> None:
        self.source.unadvertised.append(self.topic)


@dataclass
class _Attachment:
    source: "MemorySource"
    observer: Any

    def close(self) -> None:
        if self.observer in self.source.observers:
            self.source.observers.remove(self.observer)


@dataclass
class MemorySource:
    """Implements `GraphSource`; `send` and the others may be called from any thread."""

    stamp: int = 0
    published: list[tuple[str, str, bytes]] = field(default_factory=list)
    unadvertised: list[str] = field(default_factory=list)
    hooks: dict[str, Callable[[bytes], None]] = field(default_factory=dict)
    observers: list[Any] = field(default_factory=list)
    handlers: dict[str, Callable[[bytes], bytes]] = field(default_factory=dict)
    subscribe_count: int = 0

    def __post_init__(self) -> None:
        self._lock = threading.RLock()
        self._topics: dict[str, Topic] = {}
        self._services: dict[str, Service] = {}
        self._parameters: dict[str, Any] = {}
        self._subscriptions: defaultdict[str, list[_Subscription]] = defaultdict(list)
        self._kept: defaultdict[str, deque[tuple[int, bytes]]] = defaultdict(lambda: deque(maxlen=32))
        self._graph = Graph()
        self._time: int | None = None

    # What a test does to the graph -------------------------------------------------------------------

    def add_topic(self, name: str, type_name: str, *, latched: bool = False, known: bool = True) -> None:
        with self._lock:
            self._topics[name] = Topic(name, type_name, schema(type_name) if known else None, latched)
        self._tell("graph_changed")

    def remove_topic(self, name: str) -> None:
        with self._lock:
            del self._topics[name]
        self._tell("graph_changed")

    def add_service(self, service: Service, handler: Callable[[bytes], bytes]) -> None:
        with self._lock:
            self._services[service.name] = service
            self.handlers[service.name] = handler
        self._tell("graph_changed")

    def remove_service(self, name: str) -> None:
        with self._lock:
            del self._services[name]
        self._tell("graph_changed")

    def set_graph(self, graph: Graph) -> None:
        self._graph = graph
        self._tell("graph_changed")

    def set_time(self, nanoseconds: int) -> None:
        self._time = nanoseconds
        self._tell("time_advanced", nanoseconds)

    def send(self, topic: str, payload: bytes, stamp: int | None = None) -> None:
        stamp = self.stamp if stamp is None else stamp
        with self._lock:
            entry = self._topics.get(topic)
            if entry is not None and entry.latched:
                self._kept[topic].append((stamp, payload))
            listeners = list(self._subscriptions[topic])
        for subscription in listeners:
            subscription.received(stamp, payload)

    def change_parameter(self, name: str, value: Any) -> None:
        self._parameters[name] = value
        self._tell("parameters_changed", [Parameter(name, value)])

    def listener_count(self, topic: str) -> int:
        return len(self._subscriptions[topic])

    def keeps(self, topic: str) -> bool:
        return self._topics[topic].latched

    def drop(self, subscription: _Subscription) -> None:
        with self._lock:
            listeners = self._subscriptions[subscription.topic]
            if subscription in listeners:
                listeners.remove(subscription)

    def _tell(self, method: str, *arguments: Any) -> None:
        for observer in list(self.observers):
            getattr(observer, method)(*arguments)

    # GraphSource ------------------------------------------------------------------------------------

    def attach(self, observer: Any) -> _Attachment:
        self.observers.append(observer)
        return _Attachment(self, observer)

    def topics(self) -> Sequence[Topic]:
        with self._lock:
            return list(self._topics.values())

    def services(self) -> Sequence[Service]:
        with self._lock:
            return list(self._services.values())

    def graph(self) -> Graph:
        return self._graph

    def time(self) -> int | None:
        return self._time

    def subscribe(self, topic: Topic, received: Callable[[int, bytes], None]) -> _Subscription:
        subscription = _Subscription(self, topic.name, received)
        with self._lock:
            self.subscribe_count += 1
            kept = list(self._kept[topic.name]) if topic.latched else []
            self._subscriptions[topic.name].append(subscription)
        for stamp, payload in kept:
            received(stamp, payload)
        return subscription

    def advertise(self, topic: str, type_name: str) -> _Publication:
        known = self._topics.get(topic)
        if known is not None and known.type != type_name:
            raise SourceError(f"{topic} carries {known.type}, not {type_name}")
        return _Publication(self, topic, type_name)

    def call(self, service: str, request: bytes) -> Future[bytes]:
        future: Future[bytes] = Future()

        def work() -> None:
            try:
                future.set_result(self.handlers[service](request))
            except SourceError as error:
                future.set_exception(error)

        threading.Thread(target=work, daemon=True).start()
        return future

    def get_parameters(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        future: Future[Sequence[Parameter]] = Future()
        wanted = names or list(self._parameters)
        future.set_result([Parameter(name, self._parameters[name]) for name in wanted if name in self._parameters])
        return future

    def set_parameters(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        future: Future[Sequence[Parameter]] = Future()
        for parameter in parameters:
            self.change_parameter(parameter.name, parameter.value)
        future.set_result(list(parameters))
        return future
