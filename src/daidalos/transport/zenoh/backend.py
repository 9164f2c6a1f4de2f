"""Zenoh backend: one session, its liveliness tokens, and the graph from the tokens of others."""

from __future__ import annotations

import contextlib
import os
import secrets
import socket
import sys
import threading
import time
from collections.abc import Callable, Hashable
from typing import Any

import zenoh
from zenoh.handlers import Callback, FifoChannel

from daidalos.transport.backend import (
    Backend,
    BackendClient,
    BackendPublisher,
    BackendService,
    BackendSubscription,
)
from daidalos.transport.environment import DiscoveryRange, Environment, EnvironmentVariableError
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Qos
from daidalos.transport.registry import Peer, Registry
from daidalos.transport.zenoh import keys
from daidalos.transport.zenoh.config import ROUTER_PORT, meets_all, reason_of, session_config
from daidalos.transport.zenoh.endpoints import (
    ZenohClient,
    ZenohPublisher,
    ZenohService,
    ZenohSubscription,
)
from daidalos.transport.zenoh.entity_ids import EntityIds
from daidalos.transport.zenoh.history_queries import HistoryQueries
from daidalos.transport.zenoh.latched import Caches, LatchedPublisher, LatchedSubscription
from daidalos.transport.zenoh.links import disable_linger
from daidalos.transport.zenoh.pool import Pool
from daidalos.transport.zenoh.threads import limit_threads, on_lasting_thread
from daidalos.transport.zenoh.worker import Worker

_SOCKET_PATH_LIMIT = 100
"""Longest path of a Unix socket that every system takes."""

_MANY_TOKENS = 1_000_000
"""More tokens than ever wait to be read; a full channel would hold zenoh up."""

_CLOSING_S = 1.0
"""Timeout for the end of the thread that reads tokens; it may be inside a listener's callback."""

_POLL_S = 0.002
"""Polling period of `settle`."""


class ZenohBackend(Backend):
    """Membership in a domain through a zenoh peer session."""

    identifier = "rmw_zenoh_cpp"
    wide = 2

    def __init__(self, environment: Environment) -> None:
        self._environment = environment
        self._domain = environment.domain
        self._entity_ids = EntityIds()
        self._registry = Registry(self._domain)
        self._peers: set[str] = set()
        self._latched: dict[str, set[LatchedSubscription]] = {}
        self._links: Any = None
        self._lock = threading.Lock()

    def start(self, graph: Graph) -> None:
        """Open the session and connect it with every other session on this machine."""
        self._graph = graph
        with self._registry.locked():
            peers = [] if self._environment.discovery is DiscoveryRange.OFF else self._registry.peers()
            self._session_id = _new_session_id()
            listen = self._listen_endpoints()
            endpoints = [endpoint for peer in peers for endpoint in peer.endpoints]
            config = session_config(self._environment, self._session_id, listen, endpoints)
            self._pool = Pool(config.get_json("transport/shared_memory/enabled") == "true")
            self._session: Any = _open(config)
            self._session_id = str(self._session.zid())
            if meets_all(config, listen):
                self._peers = {peer.session for peer in peers}
                self._registry.register(Peer(self._session_id, tuple(listen)))
        if self._environment.discovery is DiscoveryRange.SUBNET or self._environment.static_peers:
            self._links = disable_linger(self._session)
        # Who has been answered by us has been told of everything before. (Zenoh's own space for such questions would
        # keep a file open for every session that there ever was.)
        place = keys.answers(self._session_id)
        answer = Callback(on_lasting_thread(lambda query: _answer(query, place)), indirect=False)
        self._session.declare_queryable(place, answer, complete=True, allowed_origin=zenoh.Locality.REMOTE)
        self._worker = Worker()
        self._caches = Caches(self._session, self._worker)
        self._histories = HistoryQueries(self._session, self._worker)
        graph.listen(self._on_graph_change)
        # Tokens arrive on a thread of their own: zenoh's must never wait for Python's lock while a peer goes away,
        # because undeclaring an advanced publisher waits for them while it holds that lock.
        self._tokens = self._session.liveliness().declare_subscriber(
            keys.tokens(self._domain), FifoChannel(_MANY_TOKENS), history=True
        )
        self._reader = threading.Thread(
            target=self._read_tokens, args=(self._tokens.handler,), name="graph", daemon=True
        )
        self._reader.start()

    def _read_tokens(self, channel: Any) -> None:
        for sample in channel:
            self._on_token(sample)

    def _listen_endpoints(self) -> list[str]:
        """Return the listening endpoints for peers on this machine: a socket file with a unique name.

        Where there are none, or its path would be too long, it is a port that is free now.
        """
        path = self._registry.socket_of(self._session_id)
        if sys.platform != "win32" and len(os.fsencode(path)) <= _SOCKET_PATH_LIMIT:
            return [f"unixsock-stream/{path}"]
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            return [f"tcp/127.0.0.1:{probe.getsockname()[1]}"]

    def close(self) -> None:
        """Close the session with its tokens."""
        self._registry.unregister()
        self._worker.close()
        with contextlib.suppress(zenoh.ZError):  # a peer that is stopped does not acknowledge the close in time
            self._session.close()
        self._reader.join(_CLOSING_S)
        self._registry.remove_socket(self._session_id)
        del (
            self._session,
            self._tokens,
            self._links,
            self._caches,
            self._histories,
        )  # zenoh keeps files open as long as these live

    def settle(self, timeout_s: float) -> bool:
        """Wait until the sessions that were alive at startup are connected and have declared their tokens."""
        deadline = time.monotonic() + timeout_s
        router = _is_port_open(ROUTER_PORT)

        def connected() -> bool:
            there = {str(zid) for zid in self._session.info.peers_zid()}
            routers = list(self._session.info.routers_zid())
            return (not router or bool(routers)) and self._alive() <= there

        # We look ourselves: a listener would need Python's lock within zenoh's.
        while not (complete := connected()) and time.monotonic() < deadline:
            time.sleep(_POLL_S)
        self._wait_for_answers(deadline)
        left = max(deadline - time.monotonic(), 0.05)
        # The tokens that are known already are handed out before anybody can read: all must fit into the channel.
        channel: Any = FifoChannel(_MANY_TOKENS)
        for reply in self._session.liveliness().get(keys.tokens(self._domain), handler=channel, timeout=left):
            if reply.ok is not None:
                self._add(str(reply.ok.key_expr))
        return complete

    def _wait_for_answers(self, deadline: float) -> None:
        """Wait until every peer known at startup has answered; its answer comes after its tokens."""
        silent = self._alive()
        while silent and (left := deadline - time.monotonic()) > 0:
            for peer in list(silent):
                replies = list(self._session.get(keys.answers(peer), timeout=left))
                if any(reply.ok is not None for reply in replies):
                    silent.discard(peer)
            if silent:
                time.sleep(_POLL_S)
                silent &= self._alive()

    def _alive(self) -> set[str]:
        """Return the peers known at startup that are still alive."""
        with self._registry.locked():
            return self._peers & {peer.session for peer in self._registry.peers()}

    def _on_token(self, sample: zenoh.Sample) -> None:
        token = str(sample.key_expr)
        if sample.kind == zenoh.SampleKind.PUT:
            self._add(token)
        elif keys.session_of(token) != self._session_id:
            self._graph.remove_endpoint(token)
            self._graph.remove_node(token)

    def _add(self, token: str) -> None:
        if keys.session_of(token) == self._session_id:
            return  # what is ours the session notes itself, at once
        what = keys.parse_token(token)
        if isinstance(what, NodeInfo):
            self._graph.add_node(what)
        elif what is not None:
            self._graph.add_endpoint(token, what)

    def new_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Return the description of a new local node."""
        number = self._entity_ids.acquire((name, namespace, enclave))
        token = keys.node_token(self._domain, self._session_id, number, name, namespace, enclave)
        return NodeInfo(token, name, namespace, enclave)

    def declare_node(self, node: NodeInfo) -> Callable[[], None]:
        """Declare the node's token."""
        return self._declare_token(node.key, (node.name, node.namespace, node.enclave))

    def _declare_token(self, token: str, what: Hashable) -> Callable[[], None]:
        declared = self._session.liveliness().declare_token(token)

        def undeclare() -> None:
            _undeclare(declared)
            self._entity_ids.release(what, keys.number_of(token))

        return undeclare

    def identify(
        self, kind: EndpointKind, node: NodeInfo, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[str, bytes]:
        """Return a new endpoint's token and the gid made from it."""
        number = self._entity_ids.acquire((kind, node.key, name, type_name, type_hash, qos))
        token = keys.endpoint_token(node, number, kind, name, type_name, type_hash, qos)
        return token, keys.gid_of(token)

    def _data_key(self, endpoint: EndpointInfo) -> str:
        return keys.data_key(self._domain, endpoint.name, endpoint.type_name, endpoint.type_hash)

    def declare_publisher(self, key: str, endpoint: EndpointInfo) -> BackendPublisher:
        """Declare a publisher and its token."""
        name = self._data_key(endpoint)
        remote = (
            LatchedPublisher(self._session, name, endpoint, self._pool, self._caches)
            if endpoint.qos.transient_local
            else ZenohPublisher(self._session, name, endpoint, self._pool)
        )
        remote.on_close = self._closer(key, endpoint)
        return remote

    def declare_subscription(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[[Any], None]
    ) -> BackendSubscription:
        """Declare a subscription and its token."""
        if endpoint.qos.transient_local:
            return self._declare_latched(key, endpoint, on_sample)
        remote = ZenohSubscription(self._session, self._data_key(endpoint), endpoint, on_sample)
        remote.on_close = self._closer(key, endpoint)
        return remote

    def _declare_latched(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[[Any], None]
    ) -> LatchedSubscription:
        """Declare a subscription that receives the history of all publishers, whichever is declared first."""
        request = self._histories.request
        remote = LatchedSubscription(self._session, self._data_key(endpoint), endpoint, on_sample, request)
        forget = self._closer(key, endpoint)
        with self._lock:
            self._latched.setdefault(endpoint.name, set()).add(remote)

        def close() -> None:
            with self._lock:
                members = self._latched[endpoint.name]
                members.discard(remote)
                if not members:
                    del self._latched[endpoint.name]
            forget()

        remote.on_close = close
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=endpoint.name)
        for session in {keys.session_of(one.node.key) for one in publishers if one.qos.transient_local}:
            self._ask(remote, session)
        return remote

    def _on_graph_change(self, added: bool, what: NodeInfo | EndpointInfo) -> None:
        """Make subscriptions query publishers with a history that were added."""
        if not (added and isinstance(what, EndpointInfo) and what.qos.transient_local):
            return
        if what.kind is EndpointKind.PUBLISHER:
            with self._lock:
                remotes = tuple(self._latched.get(what.name, ()))
            for remote in remotes:
                self._ask(remote, keys.session_of(what.node.key))

    def _ask(self, remote: LatchedSubscription, session: str) -> None:
        if session != self._session_id:  # endpoints of this session are served within the process
            remote.request_history(session)

    def declare_service(self, key: str, endpoint: EndpointInfo, on_request: Callable[[Any], None]) -> BackendService:
        """Declare a queryable and its token."""
        remote = ZenohService(self._session, self._data_key(endpoint), on_request)
        remote.on_close = self._closer(key, endpoint)
        return remote

    def declare_client(self, key: str, endpoint: EndpointInfo, on_response: Callable[[Any], None]) -> BackendClient:
        """Declare a querier and its token."""
        remote = ZenohClient(self._session, self._data_key(endpoint), endpoint, on_response)
        remote.on_close = self._closer(key, endpoint)
        return remote

    def _closer(self, key: str, endpoint: EndpointInfo) -> Callable[[], None]:
        """Declare an endpoint's token; return a function that undeclares it."""
        one = endpoint
        what = (one.kind, one.node.key, one.name, one.type_name, one.type_hash, one.qos)
        return self._declare_token(key, what)


def _open(config: zenoh.Config) -> zenoh.Session:
    try:
        with limit_threads():
            return zenoh.open(config)
    except zenoh.ZError as error:
        raise EnvironmentVariableError(
            f"zenoh cannot open a session: {reason_of(error)}; look at ZENOH_SESSION_CONFIG_URI, ZENOH_CONFIG_OVERRIDE "
            "and ROS_STATIC_PEERS"
        ) from None


def _new_session_id() -> str:
    """Return a random zenoh id without leading zero, which zenoh would not write."""
    first = "123456789abcdef"
    return secrets.choice(first) + secrets.token_hex(16)[1:]


def _is_port_open(port: int) -> bool:
    """Return whether a port of this machine accepts connections."""
    with socket.socket() as probe:
        probe.settimeout(0.2)
        return probe.connect_ex(("127.0.0.1", port)) == 0


def _answer(query: zenoh.Query, place: str) -> None:
    with contextlib.suppress(zenoh.ZError), query:  # who asked may be gone
        query.reply(place, b"")


def _undeclare(entity: Any) -> None:
    with contextlib.suppress(zenoh.ZError):  # the session may have been closed before
        entity.undeclare()
