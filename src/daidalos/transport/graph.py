"""Graph of a domain: nodes with their publishers, subscriptions, services and clients."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import TypeVar

from daidalos.transport.qos import Qos


class EndpointKind(Enum):
    """Type of an endpoint."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    CLIENT = "client"


@dataclass(frozen=True, slots=True)
class NodeInfo:
    """Node; `key` is unique in the domain even if two nodes have the same name."""

    key: str
    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        """Name with its namespace, such as ``/lab/talker``."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


@dataclass(frozen=True, slots=True)
class EndpointInfo:
    """Endpoint of a node.

    Attributes
    ----------
    kind, node, name
        What it is, whose, and the full name of its topic or service.
    type_name, type_hash
        Such as ``std_msgs/msg/String`` and ``RIHS01_...``; the hash is empty where the peer states none.
    gid
        16 bytes that identify the endpoint.
    """

    kind: EndpointKind
    node: NodeInfo
    name: str
    type_name: str
    type_hash: str
    qos: Qos
    gid: bytes


Group = TypeVar("Group", bound=Hashable)
Listener = Callable[[bool, NodeInfo | EndpointInfo], None]
"""Told of every change: whether it was added (else removed), and what."""


class Graph:
    """Nodes and endpoints of a domain, updated by the session; thread-safe."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._nodes: dict[str, NodeInfo] = {}
        self._endpoints: dict[str, EndpointInfo] = {}
        self._by_name: dict[tuple[str, EndpointKind], dict[str, EndpointInfo]] = {}
        self._by_node: dict[str, dict[str, EndpointInfo]] = {}
        self._listeners: tuple[Listener, ...] = ()
        self._version = 0

    def add_node(self, node: NodeInfo) -> None:
        """Add a node."""
        with self._changed:
            if node.key in self._nodes:
                return
            self._nodes[node.key] = node
        self._notify(True, node)

    def remove_node(self, key: str) -> None:
        """Remove a node; its endpoints are removed one by one as their own notifications arrive."""
        with self._changed:
            node = self._nodes.pop(key, None)
        if node:
            self._notify(False, node)

    def add_endpoint(self, key: str, endpoint: EndpointInfo) -> None:
        """Add an endpoint under a key that is unique in the domain."""
        with self._changed:
            if key in self._endpoints:
                return
            self._endpoints[key] = endpoint
            self._by_name.setdefault((endpoint.name, endpoint.kind), {})[key] = endpoint
            self._by_node.setdefault(endpoint.node.key, {})[key] = endpoint
        self._notify(True, endpoint)

    def remove_endpoint(self, key: str) -> None:
        """Remove an endpoint."""
        with self._changed:
            endpoint = self._endpoints.pop(key, None)
            if endpoint is None:
                return
            _remove(self._by_name, (endpoint.name, endpoint.kind), key)
            _remove(self._by_node, endpoint.node.key, key)
        self._notify(False, endpoint)

    def listen(self, listener: Listener) -> Callable[[], None]:
        """Call `listener` at every change, on the thread that reports it; call the result to stop."""
        with self._changed:
            self._listeners = (*self._listeners, listener)

        def stop() -> None:
            with self._changed:
                self._listeners = tuple(other for other in self._listeners if other is not listener)

        return stop

    def _notify(self, added: bool, what: NodeInfo | EndpointInfo) -> None:
        for listener in self._listeners:
            listener(added, what)
        self.notify()

    def wait_for(self, condition: Callable[[], bool], timeout_s: float | None = None) -> bool:
        """Block until `condition()` holds; it is evaluated at every change of the graph.

        Returns
        -------
        bool
            Whether it holds; False after `timeout_s` seconds (None: no limit).
        """
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            version = self._version
            if condition():
                return True
            left = None if deadline is None else deadline - time.monotonic()
            if left is not None and left <= 0:
                return False
            with self._changed:
                if self._version == version:
                    self._changed.wait(left)

    def notify(self) -> None:
        """Make `wait_for` evaluate its condition again."""
        with self._changed:
            self._version += 1
            self._changed.notify_all()

    def nodes(self) -> list[NodeInfo]:
        """Return all nodes, sorted by full name."""
        with self._changed:
            found = list(self._nodes.values())
        return sorted(found, key=lambda node: (node.full_name, node.key))

    def find_nodes(self, name: str, namespace: str) -> list[NodeInfo]:
        """Return the nodes with that name."""
        return [node for node in self.nodes() if node.name == name and node.namespace == namespace]

    def endpoints(self, *kinds: EndpointKind, name: str | None = None) -> list[EndpointInfo]:
        """Return the endpoints of the given kinds (all if none is given), optionally only those of one name."""
        with self._changed:
            if name is not None:
                groups = (self._by_name.get((name, kind)) for kind in kinds or EndpointKind)
                return [endpoint for group in groups if group for endpoint in group.values()]
            found = list(self._endpoints.values())
        return [endpoint for endpoint in found if not kinds or endpoint.kind in kinds]

    def endpoints_of(self, node: NodeInfo, *kinds: EndpointKind) -> list[EndpointInfo]:
        """Return the endpoints of a node."""
        with self._changed:
            found = list(self._by_node.get(node.key, {}).values())
        return [endpoint for endpoint in found if not kinds or endpoint.kind in kinds]


def _remove(index: dict[Group, dict[str, EndpointInfo]], group: Group, key: str) -> None:
    """Remove an endpoint from its group of an index, and the group if it is empty then."""
    members = index[group]
    del members[key]
    if not members:
        del index[group]


def names_and_types(endpoints: Iterable[EndpointInfo]) -> list[tuple[str, list[str]]]:
    """Return endpoints grouped by name: [(name, sorted type names)], sorted."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return [(name, sorted(found[name])) for name in sorted(found)]
