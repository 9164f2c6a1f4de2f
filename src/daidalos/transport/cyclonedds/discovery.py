"""Graph of a DDS domain from built-in topics and `ros_discovery_info`.

DDS knows who writes and reads what, `ros_discovery_info` which node that is. A ROS process's endpoints enter the
graph when both are known; those of other DDS programs, which have no nodes, at once.
"""

from __future__ import annotations

import ctypes as c
import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from daidalos.interfaces.codec import CdrError, codec_of
from daidalos.transport.cyclonedds import names
from daidalos.transport.cyclonedds.library import (
    ALIVE,
    BUILTIN_PARTICIPANT,
    BUILTIN_PUBLICATION,
    BUILTIN_SUBSCRIPTION,
    BuiltinEndpoint,
    BuiltinParticipant,
    Library,
    SampleInfo,
)
from daidalos.transport.cyclonedds.qos import read_qos, user_data_of
from daidalos.transport.cyclonedds.reception import Handler, Paced, Reception, Sample, SampleReader
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Qos

_LOGGER = logging.getLogger(__name__)
_BATCH = 32
PREFIX = 12
"""Number of leading bytes of a gid that identify its participant."""
_UNKNOWN = ("_NODE_NAME_UNKNOWN_", "_NODE_NAMESPACE_UNKNOWN_")
"""Name and namespace that ROS gives the nodes of programs that have none."""


@dataclass(frozen=True, slots=True)
class _Endpoint:
    """Writer or reader of a topic or of a service's requests."""

    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: Qos


@dataclass
class _Participant:
    """Remote process: its DDS data, its announced nodes, and its entries in the graph."""

    enclave: str | None = None
    """None where it is no ROS process."""
    endpoints: dict[bytes, _Endpoint] = field(default_factory=dict)
    all_gids: set[bytes] = field(default_factory=set)
    replying: set[str] = field(default_factory=set)
    """Topics of replies that it writes."""
    nodes: list[tuple[str, str, list[bytes]]] | None = None
    """(namespace, name, gids); None until it told."""
    shown_nodes: dict[str, NodeInfo] = field(default_factory=dict)
    shown_endpoints: dict[str, EndpointInfo] = field(default_factory=dict)


class Discovery:
    """Updater of a graph with the declarations of other processes in the domain.

    Parameters
    ----------
    library, participant
        The library and our participant.
    prefix
        The first bytes of our gids.
    info_reader
        A reader of `ros_discovery_info`.
    graph
        Told of every change, on a thread of its own.
    announce
        Called on that thread after `wake`, to list the local nodes for others.
    """

    def __init__(
        self,
        library: Library,
        participant: int,
        prefix: bytes,
        info_reader: int,
        graph: Graph,
        announce: Callable[[], None],
    ) -> None:
        from rmw_dds_common.msg import ParticipantEntitiesInfo

        self._library = library
        self._prefix = prefix
        self._graph = graph
        self._codec = codec_of(ParticipantEntitiesInfo)
        self._participants: dict[bytes, _Participant] = {}
        self._gids: dict[int, bytes] = {}
        self._topics: dict[bytes, str] = {}
        self._dirty: set[bytes] = set()
        self._announcement = Paced(announce)
        self._updating = Paced(self._update)
        self._reception = Reception(library, participant, "graph", self._on_batch)
        taker = SampleReader(library)
        builtin = {
            BUILTIN_PARTICIPANT: self._on_participant,
            BUILTIN_PUBLICATION: self._on_writer,
            BUILTIN_SUBSCRIPTION: self._on_reader,
        }
        for topic, handler in builtin.items():
            reader = library.check(library.dds_create_reader(participant, topic, None, None), "watch the domain")
            self._reception.add(reader, self._taking(reader, handler))

        self._reception.add(info_reader, lambda _: taker.take_all(info_reader, self._on_info))

    def wake(self) -> None:
        """List the local nodes for others soon."""
        self._announcement.request()
        self._reception.wake()

    def _on_batch(self) -> int:
        if self._dirty:
            self._updating.request()
        return min(self._announcement.run(), self._updating.run())

    def close(self) -> None:
        """Stop watching."""
        self._reception.close()

    def gid_of(self, handle: int) -> bytes | None:
        """Return the gid of the instance handle of a writer or reader, None if unknown."""
        return self._gids.get(handle)

    def is_discovered(self, prefix: bytes) -> bool:
        """Return whether a participant is in the graph with all its nodes and their endpoints."""
        participant = self._participants.get(prefix)
        if participant is None or participant.nodes is None or prefix in self._dirty:
            return False
        return all(gid in participant.all_gids for _, _, gids in participant.nodes for gid in gids)

    def all_discovered(self) -> bool:
        """Return whether every ROS participant that is known has listed its nodes and their endpoints."""
        known = tuple(self._participants.items())  # a copy: the receiving thread changes it
        return all(participant.enclave is None or self.is_discovered(prefix) for prefix, participant in known)

    def _taking(self, reader: int, handler: Callable[[int, SampleInfo], None]) -> Handler:
        """Return a callback that takes all samples of a built-in reader and updates the graph."""
        library = self._library
        infos = (SampleInfo * _BATCH)()

        def take(_: bool) -> None:
            while True:
                pointers = (c.c_void_p * _BATCH)()
                loan = c.cast(pointers, c.POINTER(c.c_void_p))
                count = library.dds_take(reader, loan, infos, _BATCH, _BATCH)
                for index in range(count):
                    handler(pointers[index] or 0, infos[index])
                if count > 0:
                    library.dds_return_loan(reader, loan, count)
                if count < _BATCH:
                    break

        return take

    def _on_participant(self, pointer: int, info: SampleInfo) -> None:
        handle = info.instance_handle
        if info.instance_state != ALIVE:
            gid = self._gids.pop(handle, None)
            if gid is not None:
                self._forget(gid[:PREFIX])
            return
        found = c.cast(pointer, c.POINTER(BuiltinParticipant)).contents
        gid = self._gids[handle] = bytes(found.key.v)
        if gid[:PREFIX] != self._prefix:
            participant = self._participants.setdefault(gid[:PREFIX], _Participant())
            participant.enclave = user_data_of(self._library, found.qos).get("enclave")
            self._dirty.add(gid[:PREFIX])

    def _on_writer(self, pointer: int, info: SampleInfo) -> None:
        self._on_endpoint(pointer, info, writes=True)

    def _on_reader(self, pointer: int, info: SampleInfo) -> None:
        self._on_endpoint(pointer, info, writes=False)

    def _on_endpoint(self, pointer: int, info: SampleInfo, *, writes: bool) -> None:
        handle = info.instance_handle
        if info.instance_state != ALIVE:
            self._forget_endpoint(handle)
            return
        found = c.cast(pointer, c.POINTER(BuiltinEndpoint)).contents
        gid = self._gids[handle] = bytes(found.key.v)
        prefix = gid[:PREFIX]
        if prefix == self._prefix:
            return  # what is ours the session notes itself
        participant = self._participants.setdefault(prefix, _Participant())
        participant.all_gids.add(gid)
        self._dirty.add(prefix)
        topic = found.topic_name.decode("utf-8", "replace")
        if writes and topic.startswith("rr/"):
            participant.replying.add(topic)
            self._topics[gid] = topic
        parsed = names.parse_endpoint(topic, found.type_name.decode("utf-8", "replace"), writes)
        if parsed is not None:
            user_data = user_data_of(self._library, found.qos)
            kind, name, type_name = parsed
            is_topic = kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
            # A service's user data tell the hash of the request, not the service's own.
            type_hash = user_data.get("typehash", "") if is_topic else ""
            qos = read_qos(self._library, found.qos, user_data)
            participant.endpoints[gid] = _Endpoint(kind, name, type_name, type_hash, qos)

    def _forget_endpoint(self, handle: int) -> None:
        gid = self._gids.pop(handle, None)
        participant = self._participants.get(gid[:PREFIX]) if gid else None
        if gid is None or participant is None:
            return
        participant.all_gids.discard(gid)
        participant.endpoints.pop(gid, None)
        topic = self._topics.pop(gid, None)
        if topic is not None and topic not in self._topics_of(gid[:PREFIX]):
            participant.replying.discard(topic)
        self._dirty.add(gid[:PREFIX])

    def _topics_of(self, prefix: bytes) -> set[str]:
        return {topic for gid, topic in self._topics.items() if gid[:PREFIX] == prefix}

    def _forget(self, prefix: bytes) -> None:
        """Remove a participant with its nodes."""
        participant = self._participants.get(prefix)
        if participant is not None:
            participant.enclave = participant.nodes = None
            participant.endpoints.clear()
            participant.all_gids.clear()
            self._dirty.add(prefix)

    def _on_info(self, sample: Sample) -> None:
        try:
            message = self._codec.decode(sample.data)
        except CdrError as error:
            _LOGGER.warning("ignored an invalid message about a process's nodes: %s", error)
            return
        prefix = bytes(message.gid.data)[:PREFIX]
        if prefix == self._prefix:
            return
        participant = self._participants.setdefault(prefix, _Participant())
        participant.nodes = [_node(entry) for entry in message.node_entities_info_seq]
        self._dirty.add(prefix)

    def _update(self) -> None:
        """Update the graph with the participants that changed."""
        dirty = tuple(self._dirty)
        for prefix in dirty:
            participant = self._participants[prefix]
            self._show(prefix, participant)
            if participant.enclave is None and not participant.all_gids and participant.nodes is None:
                del self._participants[prefix]
            self._dirty.discard(prefix)
        if dirty:
            self._graph.notify()

    def _show(self, prefix: bytes, participant: _Participant) -> None:
        nodes = dict(_nodes_of(prefix, participant))
        endpoints = dict(_endpoints_of(prefix, participant, nodes))
        shown_nodes, participant.shown_nodes = participant.shown_nodes, nodes
        shown, participant.shown_endpoints = participant.shown_endpoints, endpoints
        for key in [key for key, endpoint in shown.items() if endpoints.get(key) != endpoint]:
            self._graph.remove_endpoint(key)
        for key in [key for key in shown_nodes if nodes.get(key) != shown_nodes[key]]:
            self._graph.remove_node(key)
        for key, node in nodes.items():
            if shown_nodes.get(key) != node:
                self._graph.add_node(node)
        for key, endpoint in endpoints.items():
            if shown.get(key) != endpoint:
                self._graph.add_endpoint(key, endpoint)


def _node(entry: Any) -> tuple[str, str, list[bytes]]:
    gids = [bytes(gid.data) for gid in (*entry.reader_gid_seq, *entry.writer_gid_seq)]
    return entry.node_namespace, entry.node_name, gids


def node_key(prefix: bytes, namespace: str, name: str, number: int) -> str:
    """Return the graph's key of a process's node, the `number`-th of its name."""
    return f"{prefix.hex()}/{number}{namespace.rstrip('/')}/{name}"


def _nodes_of(prefix: bytes, participant: _Participant) -> Iterator[tuple[str, NodeInfo]]:
    if participant.enclave is None:
        return
    seen: dict[tuple[str, str], int] = {}
    for namespace, name, _ in participant.nodes or ():
        number = seen[namespace, name] = seen.get((namespace, name), -1) + 1
        key = node_key(prefix, namespace, name, number)
        yield key, NodeInfo(key, name, namespace, participant.enclave)


def _endpoints_of(
    prefix: bytes, participant: _Participant, nodes: dict[str, NodeInfo]
) -> Iterator[tuple[str, EndpointInfo]]:
    owners: dict[bytes, NodeInfo] = {}
    for node, (_, _, gids) in zip(nodes.values(), participant.nodes or (), strict=False):
        owners.update(dict.fromkeys(gids, node))
    name, namespace = _UNKNOWN
    stranger = NodeInfo(f"{prefix.hex()}/", name, namespace)
    for gid, endpoint in participant.endpoints.items():
        owner = owners.get(gid) or (stranger if participant.enclave is None else None)
        if owner is None:
            continue  # its process is about to tell whose it is
        if endpoint.kind is EndpointKind.SERVICE and names.reply_topic_of(endpoint.name) not in participant.replying:
            continue  # it could not answer yet
        info = EndpointInfo(
            endpoint.kind, owner, endpoint.name, endpoint.type_name, endpoint.type_hash, endpoint.qos, gid
        )
        yield gid.hex(), info
