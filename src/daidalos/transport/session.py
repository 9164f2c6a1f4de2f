"""Session of a process in a ROS graph, which creates publishers, subscriptions, services and clients."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec import codec_of
from daidalos.transport.abandoned import AbandonedObjects
from daidalos.transport.backend import Backend
from daidalos.transport.client import Client
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.memory import keep_memory
from daidalos.transport.publisher import Publisher
from daidalos.transport.qos import Qos, incompatibilities
from daidalos.transport.service import Service
from daidalos.transport.subscription import Impairment, Subscription

Watcher = Callable[[bool, EndpointInfo], None]


def _nothing() -> None:
    """Do nothing; the default callback."""


class Session:
    """Nodes and endpoints of this process in one domain of one middleware.

    Parameters
    ----------
    backend
        Carries what crosses the process's border.

    Attributes
    ----------
    graph
        Everything known of the domain, ours included.
    """

    def __init__(self, backend: Backend) -> None:
        self.backend = backend
        self.graph = Graph()
        self._lock = threading.RLock()
        # In the order of their creation, which is that of deliveries; sets have none that lasts.
        self._publishers: dict[str, dict[Publisher, None]] = {}
        self._subscriptions: dict[str, dict[Subscription, None]] = {}
        self._services: dict[str, dict[Service, None]] = {}
        self._clients: dict[str, dict[Client, None]] = {}
        self._watchers: dict[tuple[str, EndpointKind], dict[Watcher, None]] = {}
        self._impairments: dict[str, Impairment] = {}
        self._own: set[bytes] = set()
        self._closed = False
        self._abandoned = AbandonedObjects()
        self._stop_listening = self.graph.listen(self._on_graph_change)
        keep_memory()
        backend.start(self.graph)

    def close(self) -> None:
        """Leave the graph with all nodes and endpoints; further calls do nothing."""
        with self._lock:
            closed, self._closed = self._closed, True
        if closed:
            return
        self._abandoned.finish()
        self._stop_listening()
        with self._lock:
            groups = (self._publishers, self._subscriptions, self._services, self._clients)
            members: list[Any] = [one for group in groups for many in group.values() for one in many]
        for member in members:
            member.close()
        self.backend.close()

    def abandon(self, close: Callable[[], None]) -> None:
        """Close something unreferenced in a thread; `close` must not refer to it."""
        self._abandoned.close(close)

    def create_node(self, name: str, namespace: str, enclave: str = "/") -> tuple[NodeInfo, Callable[[], None]]:
        """Create a node; return its description and a function that removes it."""
        node = self.backend.new_node(name, namespace, enclave)
        undeclare = self.backend.declare_node(node)
        self.graph.add_node(node)
        once = [undeclare]

        def remove() -> None:
            if once:
                once.pop()()
                self.graph.remove_node(node.key)

        return node, remove

    def create_publisher(self, node: NodeInfo, topic: str, message_type: Any, qos: Qos) -> Publisher:
        """Create a publisher of messages of a class on a topic."""
        key, endpoint = self._endpoint(EndpointKind.PUBLISHER, node, topic, message_type, qos)
        publisher = Publisher(endpoint, codec_of(message_type, self.backend.wide))
        remote = self.backend.declare_publisher(key, endpoint)
        publisher.attach(remote, lambda: self._remove(key, self._publishers, publisher))
        remote.watch_readers(lambda: self._on_readers_change(publisher))
        with self._lock:
            self._publishers.setdefault(topic, {})[publisher] = None
            subscriptions = self._subscriptions.get(topic, ())
            publisher.add_targets(other for other in subscriptions if _compatible(endpoint, other.endpoint))
            for other in self.graph.endpoints(EndpointKind.SUBSCRIPTION, name=topic):
                self._note_remote_subscription(publisher, other)
        self.graph.add_endpoint(key, endpoint)
        return publisher

    def create_subscription(
        self, node: NodeInfo, topic: str, message_type: Any, qos: Qos, on_ready: Callable[[], None] = _nothing
    ) -> Subscription:
        """Create a subscription to messages of a class on a topic; `on_ready` is called when one was queued."""
        key, endpoint = self._endpoint(EndpointKind.SUBSCRIPTION, node, topic, message_type, qos)
        subscription = Subscription(endpoint, codec_of(message_type, self.backend.wide), on_ready)
        with self._lock:
            subscription.impairment = self._impairments.get(topic)
            self._subscriptions.setdefault(topic, {})[subscription] = None
            for other in self.graph.endpoints(EndpointKind.PUBLISHER, name=topic):
                _refuse_if_incompatible(subscription, other)
            for publisher in self._publishers.get(topic, ()):
                if _compatible(publisher.endpoint, endpoint):
                    publisher.add_targets((subscription,))
                    if qos.transient_local:
                        publisher.replay(subscription)
        remote = self.backend.declare_subscription(key, endpoint, subscription.accept)
        subscription.attach(remote, lambda: self._remove(key, self._subscriptions, subscription))
        self.graph.add_endpoint(key, endpoint)
        return subscription

    def impair(self, topic: str, impairment: Impairment | None) -> None:
        """Set the impairment of all connections of this process on a topic, present and future ones."""
        with self._lock:
            if impairment is None:
                self._impairments.pop(topic, None)
            else:
                self._impairments[topic] = impairment
            for subscription in self._subscriptions.get(topic, ()):
                subscription.impairment = impairment

    def create_service(
        self, node: NodeInfo, name: str, service_type: Any, qos: Qos, on_ready: Callable[[], None] = _nothing
    ) -> Service:
        """Create a service; `on_ready` is called when a request was queued."""
        key, endpoint = self._endpoint(EndpointKind.SERVICE, node, name, service_type, qos)
        wide = self.backend.wide
        request, response = codec_of(service_type.Request, wide), codec_of(service_type.Response, wide)
        service = Service(endpoint, request, response, on_ready)
        remote = self.backend.declare_service(key, endpoint, service.accept)
        service.attach(remote, lambda: self._remove(key, self._services, service))
        with self._lock:
            self._services.setdefault(name, {})[service] = None
            self._match_service(name)
        self.graph.add_endpoint(key, endpoint)
        return service

    def create_client(
        self, node: NodeInfo, name: str, service_type: Any, qos: Qos, on_ready: Callable[[], None] = _nothing
    ) -> Client:
        """Create a client; `on_ready` is called when a response was queued."""
        key, endpoint = self._endpoint(EndpointKind.CLIENT, node, name, service_type, qos)
        wide = self.backend.wide
        request, response = codec_of(service_type.Request, wide), codec_of(service_type.Response, wide)
        client = Client(endpoint, request, response, on_ready)
        remote = self.backend.declare_client(key, endpoint, client.accept)
        client.attach(remote, lambda: self._remove(key, self._clients, client))
        with self._lock:
            self._clients.setdefault(name, {})[client] = None
            self._match_service(name)
        self.graph.add_endpoint(key, endpoint)
        self._note_servers(client)
        return client

    def server_is_ready(self, client: Client) -> bool:
        """Return whether a server of the client's service is available."""
        if client.has_local_server:
            return True
        mine = client.endpoint
        return any(_same_type(mine, other) for other in self.graph.endpoints(EndpointKind.SERVICE, name=mine.name))

    def matching_endpoints(self, endpoint: EndpointInfo) -> list[EndpointInfo]:
        """Return the endpoints that an endpoint of a topic exchanges samples with."""
        if endpoint.kind is EndpointKind.PUBLISHER:
            others = self.graph.endpoints(EndpointKind.SUBSCRIPTION, name=endpoint.name)
            return [other for other in others if _compatible(endpoint, other)]
        others = self.graph.endpoints(EndpointKind.PUBLISHER, name=endpoint.name)
        return [other for other in others if _compatible(other, endpoint)]

    def watch(self, name: str, watcher: Watcher, *kinds: EndpointKind) -> Callable[[], None]:
        """Call ``watcher(added, endpoint)`` when an endpoint of a topic or service is added or removed.

        It is told of those that are there already, too, and of the given kinds only (all if none is given). The
        result ends it.
        """
        groups = [(name, kind) for kind in kinds or EndpointKind]
        with self._lock:
            for group in groups:
                self._watchers.setdefault(group, {})[watcher] = None
            present = self.graph.endpoints(*kinds, name=name)
        for endpoint in present:
            watcher(True, endpoint)

        def stop() -> None:
            with self._lock:
                for group in groups:
                    watchers = self._watchers.get(group, {})
                    watchers.pop(watcher, None)
                    if not watchers:
                        self._watchers.pop(group, None)

        return stop

    def _endpoint(
        self, kind: EndpointKind, node: NodeInfo, name: str, interface: Any, qos: Qos
    ) -> tuple[str, EndpointInfo]:
        type_name, type_hash = interface._TYPE_NAME, interface._TYPE_HASH
        key, gid = self.backend.identify(kind, node, name, type_name, type_hash, qos)
        self._own.add(gid)
        return key, EndpointInfo(kind, node, name, type_name, type_hash, qos, gid)

    def _remove(self, key: str, group: dict[str, Any], member: Any) -> None:
        name = member.endpoint.name
        with self._lock:
            members = group.get(name)
            if members and member in members:
                del members[member]
                if not members:
                    del group[name]
            if group is self._subscriptions:
                for publisher in self._publishers.get(name, ()):
                    publisher.remove_target(member)
            elif group is not self._publishers:
                self._match_service(name)
        member.detach()
        self.graph.remove_endpoint(key)
        self._own.discard(member.endpoint.gid)

    def _match_service(self, name: str) -> None:
        """Match the clients and the service in this process."""
        services = self._services.get(name, ())
        for client in self._clients.get(name, ()):
            matching = (one for one in services if _same_type(one.endpoint, client.endpoint))
            client.set_server(next(matching, None))

    def _on_graph_change(self, added: bool, what: NodeInfo | EndpointInfo) -> None:
        if not isinstance(what, EndpointInfo):
            return
        with self._lock:
            if what.kind is EndpointKind.PUBLISHER:
                for subscription in self._subscriptions.get(what.name, ()):
                    if added:
                        _refuse_if_incompatible(subscription, what)
                    else:
                        subscription.admit(what.gid)
            elif what.kind is EndpointKind.SUBSCRIPTION and what.gid not in self._own:
                for publisher in self._publishers.get(what.name, ()):
                    if added:
                        self._note_remote_subscription(publisher, what)
                    else:
                        publisher.remove_remote_subscription(what.gid)
            elif what.kind is EndpointKind.SERVICE and what.gid not in self._own:
                for client in self._clients.get(what.name, ()):
                    self._note_servers(client)
            watchers = tuple(self._watchers.get((what.name, what.kind), ()))
        for watcher in watchers:
            watcher(added, what)

    def _note_servers(self, client: Client) -> None:
        """Pass to a client the servers of other processes that have its type."""
        mine = client.endpoint
        others = self.graph.endpoints(EndpointKind.SERVICE, name=mine.name)
        client.set_remote_servers(
            frozenset(other.gid for other in others if other.gid not in self._own and _same_type(mine, other))
        )

    def _on_readers_change(self, publisher: Publisher) -> None:
        """Update a publisher of which the middleware itself has gained or lost readers."""
        with self._lock:
            publisher.update_remote()
        self.graph.notify()

    def _note_remote_subscription(self, publisher: Publisher, other: EndpointInfo) -> None:
        """Record a subscription of another process that has the publisher's type; its QoS may be laxer."""
        if other.gid not in self._own and _same_type(publisher.endpoint, other):
            publisher.add_remote_subscription(other.gid)


def _refuse_if_incompatible(subscription: Subscription, publisher: EndpointInfo) -> None:
    """Reject samples of a publisher with incompatible QoS; the middleware may not check it."""
    if incompatibilities(publisher.qos, subscription.endpoint.qos):
        subscription.refuse(publisher.gid)


def _same_type(one: EndpointInfo, other: EndpointInfo) -> bool:
    """Return whether two endpoints have the same type; a missing hash matches any."""
    hashes = {one.type_hash, other.type_hash} - {""}
    return one.type_name == other.type_name and len(hashes) <= 1


def _compatible(publisher: EndpointInfo, subscription: EndpointInfo) -> bool:
    return _same_type(publisher, subscription) and not incompatibilities(publisher.qos, subscription.qos)
