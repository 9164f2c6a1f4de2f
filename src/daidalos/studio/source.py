"""The interface between the studio's server and a ROS graph.

Nothing here depends on a middleware: messages, requests and responses are CDR bytes with their encapsulation
header, types are spelled ``package/msg/Name``, and a schema is the text of a definition followed by those
of its dependencies (the ``ros2msg`` schema of MCAP and Foxglove).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Protocol

ParameterValue = (
    bool | int | float | str | bytes | list[bool] | list[int] | list[float] | list[str] | None
)  # what a ROS parameter may hold; None is a parameter that is not set
MessageCallback = Callable[[int, bytes], None]
"""Receives the time of arrival on the graph's clock (ns) and the message's CDR bytes."""


@dataclass(frozen=True)
class Topic:
    """A topic that the page may subscribe to.

    Attributes
    ----------
    name
        Absolute name, e.g. ``/scan``.
    type
        Full type, e.g. ``sensor_msgs/msg/LaserScan``.
    schema
        The definition with its dependencies; None where nobody knows it.
    latched
        Whether a publisher keeps messages for late subscribers (transient local durability).
    """

    name: str
    type: str
    schema: str | None
    latched: bool = False


@dataclass(frozen=True)
class Service:
    """A service that the page may call; schemas as in `Topic`."""

    name: str
    type: str
    request_schema: str
    response_schema: str


@dataclass(frozen=True)
class Parameter:
    """A parameter of a node, named ``/node.parameter``."""

    name: str
    value: ParameterValue


@dataclass(frozen=True)
class Graph:
    """Publishers, subscribers and servers: names of topics and services to names of nodes."""

    publishers: Mapping[str, frozenset[str]] = field(default_factory=dict)
    subscribers: Mapping[str, frozenset[str]] = field(default_factory=dict)
    services: Mapping[str, frozenset[str]] = field(default_factory=dict)


class Handle(Protocol):
    """An opened resource; closing it twice is harmless."""

    def close(self) -> None:
        """Close it; no callback starts after this returns."""


class Publication(Handle, Protocol):
    """A topic that was advertised for a client."""

    def publish(self, payload: bytes) -> None:
        """Send one message, CDR with its encapsulation header."""


class Observer(Protocol):
    """Receives changes; a source may call it from any thread, and it returns at once."""

    def graph_changed(self) -> None:
        """Receive that topics, services or their nodes have changed."""

    def time_advanced(self, nanoseconds: int) -> None:
        """Receive the simulated time in ns; never called where time is not simulated."""

    def parameters_changed(self, parameters: Sequence[Parameter]) -> None:
        """Receive new values of parameters."""


class GraphSource(Protocol):
    """A ROS graph as the studio's server sees it.

    The server calls these methods from its own thread and expects them to return without waiting: what
    takes time answers through a future. Callbacks may come from any thread.
    """

    def attach(self, observer: Observer) -> Handle:
        """Call the observer at every change until the handle is closed."""

    def topics(self) -> Sequence[Topic]:
        """Return the topics that can be subscribed to."""

    def services(self) -> Sequence[Service]:
        """Return the services that can be called."""

    def graph(self) -> Graph:
        """Return the nodes that publish, subscribe and serve."""

    def time(self) -> int | None:
        """Return simulated time in ns, or None where time is not simulated (yet)."""

    def subscribe(self, topic: Topic, received: MessageCallback) -> Handle:
        """Subscribe to a topic; every subscription to a latched topic receives its kept messages first."""

    def advertise(self, topic: str, type_name: str) -> Publication:
        """Advertise a topic for a client; raises `SourceError` where that is not possible."""

    def call(self, service: str, request: bytes) -> Future[bytes]:
        """Call a service; the future holds the response or a `SourceError`."""

    def get_parameters(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        """Read parameters, all that exist where `names` is empty; unknown names are left out."""

    def set_parameters(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        """Set parameters and answer with the values they have now."""


class SourceError(Exception):
    """The graph cannot do what a client asked; the text is shown to that client."""
