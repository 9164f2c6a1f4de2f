"""DDS backend: one participant with its entities, and the discovery messages about its nodes."""

from __future__ import annotations

import contextlib
import ctypes as c
import itertools
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from daidalos.interfaces.codec import codec_of
from daidalos.transport.backend import (
    Backend,
    BackendClient,
    BackendPublisher,
    BackendService,
    BackendSubscription,
)
from daidalos.transport.cyclonedds import names
from daidalos.transport.cyclonedds.config import domain_config
from daidalos.transport.cyclonedds.discovery import PREFIX, Discovery, node_key
from daidalos.transport.cyclonedds.endpoints import (
    DdsClient,
    DdsPublisher,
    DdsService,
    DdsSubscription,
)
from daidalos.transport.cyclonedds.library import (
    RETCODE_PRECONDITION_NOT_MET,
    DdsError,
    Guid,
    Library,
    TopicDescriptor,
    load,
)
from daidalos.transport.cyclonedds.loopback import confine, drops_what_others_send
from daidalos.transport.cyclonedds.qos import HISTORY_KEY, dds_qos, history_text
from daidalos.transport.cyclonedds.reception import Reception, SampleReader
from daidalos.transport.cyclonedds.writer import Writer
from daidalos.transport.dds_types import dds_type
from daidalos.transport.environment import DiscoveryRange, Environment, EnvironmentVariableError
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Durability, History, Qos
from daidalos.transport.registry import Peer, Registry

_DISCOVERY_S = 0.5
"""Time after our start in which participants that are in no registry answer; ROS 2's own tools wait as long."""
_POLL_S = 0.02
_ONE_OCTET = (c.c_uint32 * 3)(0x01010000, 0, 0)
"""Type description for the library, which only handles serialized samples: one octet."""
_INFO_QOS = Qos(durability=Durability.TRANSIENT_LOCAL, depth=1)
_INFO_READER_QOS = Qos(durability=Durability.TRANSIENT_LOCAL, history=History.KEEP_ALL, depth=0)


@dataclass
class _Entities:
    """Writer and reader of a local endpoint; services and clients have both."""

    writer: int | None = None
    reader: int | None = None
    gids: tuple[list[Any], list[Any]] = field(default_factory=lambda: ([], []))
    """Those of readers and of writers, as the node's entry lists them."""


class CycloneBackend(Backend):
    """Membership in a domain through a DDS participant."""

    identifier = "rmw_cyclonedds_cpp"
    wide = 4

    def __init__(self, environment: Environment) -> None:
        self._environment = environment
        self._library = load()
        self._registry = Registry(environment.domain, family="cyclonedds")
        self._number = itertools.count(1).__next__
        self._lock = threading.RLock()
        self._entities: dict[str, _Entities] = {}
        self._nodes: dict[str, tuple[NodeInfo, list[_Entities]]] = {}
        self._enclave = ""

    def start(self, graph: Graph) -> None:
        """Create the participant and start to watch the domain."""
        library = self._library
        self._graph = graph
        with self._registry.locked():
            self._peers = [] if self._environment.discovery is DiscoveryRange.OFF else self._registry.peers()
            self._domain = _join_domain(library, self._environment)
            try:
                self._participant = self._make_participant()
            except DdsError:
                _leave_domain(library, self._domain)
                raise
            self._gid = self._gid_of_entity(self._participant)
            self._registry.register(Peer(self._gid[:PREFIX].hex(), ()))
        self._started = time.monotonic()
        self._taker = SampleReader(library)
        self.receiver = self._reception = Reception(library, self._participant, "dds")
        info_type = names.DISCOVERY_TYPE
        info_hash = names.write_user_data(typehash=names.discovery_type_hash())
        info_reader = self._make(names.DISCOVERY_TOPIC, info_type, _INFO_READER_QOS, info_hash, writes=False)
        info_writer = self._make(names.DISCOVERY_TOPIC, info_type, _INFO_QOS, info_hash, writes=True)
        self._info_writer = Writer(library, info_writer, names.DISCOVERY_TOPIC, _INFO_QOS.limit, keeps_newest=True)
        prefix = self._gid[:PREFIX]
        self._discovery = Discovery(library, self._participant, prefix, info_reader, graph, self._announce)

    def close(self) -> None:
        """Delete the participant with all its entities."""
        self._registry.unregister()
        self._reception.close()
        self._discovery.close()
        with self._lock:
            self._library.dds_delete(self._participant)
            _leave_domain(self._library, self._domain)

    def settle(self, timeout_s: float) -> bool:
        """Wait until discovery has come to rest; return whether it did in time.

        That is: `_DISCOVERY_S` after our start, as soon as every participant that is known, by the registry of this
        machine or by DDS, has listed its nodes and their endpoints.
        """
        deadline = time.monotonic() + timeout_s
        earliest = self._started + (0.0 if self._environment.discovery is DiscoveryRange.OFF else _DISCOVERY_S)

        def complete() -> bool:
            known = all(self._discovery.is_discovered(bytes.fromhex(session)) for session in self._alive())
            return known and self._discovery.all_discovered()

        while (now := time.monotonic()) < deadline:
            if now >= earliest and complete():
                return True
            self._graph.wait_for(lambda: False, min(max(earliest - now, _POLL_S), deadline - now))
        return False

    def _alive(self) -> set[str]:
        """Return the sessions known at startup that are still alive."""
        if not self._peers:
            return set()
        with self._registry.locked():
            return {peer.session for peer in self._peers} & {peer.session for peer in self._registry.peers()}

    def new_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Return the description of a new local node."""
        return NodeInfo(node_key(self._gid[:PREFIX], namespace, name, self._number()), name, namespace, enclave)

    def declare_node(self, node: NodeInfo) -> Callable[[], None]:
        """Announce a local node."""
        with self._lock:
            self._nodes[node.key] = (node, [])
            self._show_enclave(node.enclave)
        self._discovery.wake()

        def undeclare() -> None:
            with self._lock:
                self._nodes.pop(node.key, None)
            self._discovery.wake()

        return undeclare

    def identify(
        self, kind: EndpointKind, node: NodeInfo, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[str, bytes]:
        """Create an endpoint's writer or reader, whose gid becomes the endpoint's."""
        with self._lock:
            if kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
                entities, gid = self._make_topic_end(kind, name, type_name, type_hash, qos)
            else:
                entities, gid = self._make_service_end(kind, name, type_name, qos)
            self._entities[gid.hex()] = entities
        return gid.hex(), gid

    def declare_publisher(self, key: str, endpoint: EndpointInfo) -> BackendPublisher:
        """Return the writer and announce its node."""
        writer, _ = self._declare(key, endpoint)
        remote = Writer(self._library, writer, endpoint.name, endpoint.qos.limit)
        return DdsPublisher(self._library, self._reception, remote, self._closer(key, endpoint))

    def declare_subscription(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[..., bool]
    ) -> BackendSubscription:
        """Return the reader and announce its node."""
        _, reader = self._declare(key, endpoint)
        close = self._closer(key, endpoint)
        return DdsSubscription(self._taker, self._reception, reader, on_sample, self._gid_of_writer, close)

    def declare_service(self, key: str, endpoint: EndpointInfo, on_request: Callable[[Any], None]) -> BackendService:
        """Return reader and writer and announce their node."""
        writer, reader = self._declare(key, endpoint)
        close = self._closer(key, endpoint)
        replies = Writer(self._library, writer, endpoint.name, endpoint.qos.limit)
        return DdsService(self._library, self._taker, self._reception, reader, replies, on_request, close)

    def declare_client(self, key: str, endpoint: EndpointInfo, on_response: Callable[[Any], None]) -> BackendClient:
        """Return reader and writer and announce their node."""
        writer, reader = self._declare(key, endpoint)
        handle = c.c_uint64()
        self._library.check(self._library.dds_get_instance_handle(writer, c.byref(handle)), "number a client")
        close = self._closer(key, endpoint)
        requests = Writer(self._library, writer, endpoint.name, endpoint.qos.limit)
        return DdsClient(self._taker, self._reception, reader, requests, handle.value, on_response, close)

    def _declare(self, key: str, endpoint: EndpointInfo) -> tuple[int, int]:
        """Add an endpoint to its node; return its writer and reader (0 for none)."""
        with self._lock:
            entities = self._entities[key]
            _, owned = self._nodes.get(endpoint.node.key, (None, []))
            owned.append(entities)
        self._discovery.wake()
        return entities.writer or 0, entities.reader or 0

    def _closer(self, key: str, endpoint: EndpointInfo) -> Callable[[], None]:
        """Return a function that removes an endpoint from its node and deletes its reader."""

        def close() -> None:
            with self._lock:
                entities = self._entities.pop(key, None)
                if entities is None:
                    return
                _, owned = self._nodes.get(endpoint.node.key, (None, []))
                if entities in owned:
                    owned.remove(entities)
            self._discovery.wake()
            if entities.reader is not None:
                self._reception.remove(entities.reader)
                self._library.dds_delete(entities.reader)

        return close

    def _make_topic_end(
        self, kind: EndpointKind, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[_Entities, bytes]:
        writes = kind is EndpointKind.PUBLISHER
        data = names.write_user_data(typehash=type_hash, **{HISTORY_KEY: history_text(qos)})
        entity = self._make(names.topic_of(name), type_name, qos, data, writes=writes)
        gid = self._gid_of_entity(entity)
        if writes:
            return _Entities(writer=entity, gids=([], [_listed(gid)])), gid
        return _Entities(reader=entity, gids=([_listed(gid)], [])), gid

    def _make_service_end(self, kind: EndpointKind, name: str, type_name: str, qos: Qos) -> tuple[_Entities, bytes]:
        """Create the reader and the writer of a service or client, marked as belonging together."""
        serves = kind is EndpointKind.SERVICE
        mark = {"serviceid" if serves else "clientid": names.dotted(self._gid[:PREFIX] + _four_bytes(self._number()))}
        request, response = (
            (topic, part, names.write_user_data(**mark, typehash=part_hash, **{HISTORY_KEY: history_text(qos)}))
            for topic, (part, part_hash) in zip(
                (names.request_topic_of(name), names.reply_topic_of(name)),
                names.parts_of_service(type_name),
                strict=True,
            )
        )
        read, written = (request, response) if serves else (response, request)
        reader = self._make(read[0], read[1], qos, read[2], writes=False)
        writer = self._make(written[0], written[1], qos, written[2], writes=True)
        read_gid, written_gid = self._gid_of_entity(reader), self._gid_of_entity(writer)
        gids = ([_listed(read_gid)], [_listed(written_gid)])
        return _Entities(writer, reader, gids), read_gid if serves else written_gid

    def _make(self, topic: str, type_name: str, qos: Qos, user_data: bytes, *, writes: bool) -> int:
        """Create a writer or reader."""
        library = self._library
        described = TopicDescriptor(
            size=1, align=1, type_name=dds_type(type_name).encode(), ops_count=2, ops=_ONE_OCTET, meta=b""
        )
        entity = library.check(
            library.dds_create_topic(self._participant, c.byref(described), topic.encode(), None, None),
            f"make the topic '{topic}' of type '{type_name}'",
        )
        create, what = (library.dds_create_writer, "write") if writes else (library.dds_create_reader, "read")
        try:
            with dds_qos(library, qos, user_data, writes=writes) as handle:
                return library.check(create(self._participant, entity, handle, None), f"{what} the topic '{topic}'")
        finally:
            library.dds_delete(entity)  # it lives on in what was made of it

    def _make_participant(self) -> int:
        library = self._library
        with _user_data(library, names.write_user_data(enclave="/")) as qos:
            made = library.dds_create_participant(self._environment.domain, qos, None)
        self._enclave = "/"
        return library.check(made, f"join domain {self._environment.domain}")

    def _show_enclave(self, enclave: str) -> None:
        """Announce the enclave of the local nodes; a process has one."""
        if enclave and enclave != self._enclave:
            self._enclave = enclave
            with _user_data(self._library, names.write_user_data(enclave=enclave)) as qos:
                self._library.dds_set_qos(self._participant, qos)

    def _gid_of_entity(self, entity: int) -> bytes:
        guid = Guid()
        self._library.check(self._library.dds_get_guid(entity, c.byref(guid)), "identify an entity")
        return bytes(guid.v)

    def _gid_of_writer(self, reader: int, handle: int) -> bytes:
        """Return the gid of the writer behind a sample."""
        gid = self._discovery.gid_of(handle)
        if gid is not None:
            return gid
        library = self._library
        endpoint = library.dds_get_matched_publication_data(reader, handle)
        if not endpoint:
            return bytes(16)
        gid = bytes(endpoint.contents.key.v)
        library.dds_builtintopic_free_endpoint(endpoint)
        return gid

    def _announce(self) -> None:
        """Announce all local nodes with their writers and readers."""
        from rmw_dds_common.msg import NodeEntitiesInfo, ParticipantEntitiesInfo

        with self._lock:
            entries = [
                NodeEntitiesInfo(
                    node_namespace=node.namespace,
                    node_name=node.name,
                    reader_gid_seq=[gid for one in owned for gid in one.gids[0]],
                    writer_gid_seq=[gid for one in owned for gid in one.gids[1]],
                )
                for node, owned in self._nodes.values()
            ]
        message = ParticipantEntitiesInfo(gid=_listed(self._gid), node_entities_info_seq=entries)
        self._info_writer.write(codec_of(ParticipantEntitiesInfo).parts(message))


def _listed(gid: bytes) -> Any:
    """Return a gid as node entries list it."""
    from rmw_dds_common.msg import Gid

    return Gid(data=gid)


def _four_bytes(number: int) -> bytes:
    return number.to_bytes(4, "big")


@contextlib.contextmanager
def _user_data(library: Library, data: bytes) -> Iterator[int]:
    """Return a profile that contains only user data."""
    qos = library.dds_create_qos()
    try:
        library.dds_qset_userdata(qos, data, len(data))
        yield qos
    finally:
        library.dds_delete_qos(qos)


_domains_lock = threading.Lock()
_domains: dict[int, tuple[int | None, int]] = {}
"""Domains of this process: their entities (None for domains created elsewhere) and their number of users."""


def _join_domain(library: Library, environment: Environment) -> int:
    """Configure the domain unless this process already did; return its number for `_leave_domain`."""
    number = environment.domain
    with _domains_lock:
        entity, users = _domains.get(number, (None, 0))
        if not users:
            made = library.dds_create_domain(number, domain_config(environment).encode())
            if made < 0 and made != RETCODE_PRECONDITION_NOT_MET:
                raise EnvironmentVariableError(
                    f"DDS could not configure domain {number}: {library.dds_strretcode(made).decode()}; look at "
                    "CYCLONEDDS_URI and ROS_STATIC_PEERS, whether a network interface is up, and whether more than a "
                    "hundred processes are in the domain"
                )
            entity = made if made >= 0 else None
            if drops_what_others_send(environment):
                confine(number)
        _domains[number] = (entity, users + 1)
    return number


def _leave_domain(library: Library, number: int) -> None:
    with _domains_lock:
        entity, users = _domains.pop(number)
        if users > 1:
            _domains[number] = (entity, users - 1)
        elif entity is not None:
            library.dds_delete(entity)
