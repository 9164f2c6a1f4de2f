"""Key expressions and liveliness tokens of rmw_zenoh: names, types and QoS in their wire format."""

from __future__ import annotations

from typing import TypeVar

from xxhash import xxh3_128_intdigest

from daidalos.transport.dds_types import dds_type, ros_type
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo
from daidalos.transport.qos import (
    DEFAULT_DEPTH,
    INFINITE_NS,
    Durability,
    History,
    Liveliness,
    Qos,
    Reliability,
)

_ADMIN = "@ros2_lv"
_NO_HASH = "TypeHashNotSupported"
_KINDS = {
    EndpointKind.PUBLISHER: "MP",
    EndpointKind.SUBSCRIPTION: "MS",
    EndpointKind.SERVICE: "SS",
    EndpointKind.CLIENT: "SC",
}
_KINDS_BY_TEXT = {text: kind for kind, text in _KINDS.items()}
_NODE = "NN"
_S = 1_000_000_000
_Policy = TypeVar("_Policy", Reliability, Durability, History, Liveliness)


def tokens(domain: int) -> str:
    """Return the key expression that covers every liveliness token of a domain."""
    return f"{_ADMIN}/{domain}/**"


def answers(session: str) -> str:
    """Return the key on which this session answers liveliness checks."""
    return f"@daidalos/{session}"


def data_key(domain: int, name: str, type_name: str, type_hash: str) -> str:
    """Return the key of samples, requests and replies."""
    return f"{domain}/{name.strip('/')}/{dds_type(type_name)}/{type_hash or _NO_HASH}"


def node_token(domain: int, session: str, number: int, name: str, namespace: str, enclave: str) -> str:
    """Return the liveliness token of a node."""
    who = f"{_mangle(enclave)}/{_mangle(namespace)}/{name}"
    return f"{_ADMIN}/{domain}/{session}/{number}/{number}/{_NODE}/{who}"


def endpoint_token(
    node: NodeInfo, number: int, kind: EndpointKind, name: str, type_name: str, type_hash: str, qos: Qos
) -> str:
    """Return the liveliness token of an endpoint of the node with the token `node.key`."""
    admin, domain, session, node_number, *_ = node.key.split("/")
    who = f"{_mangle(node.enclave)}/{_mangle(node.namespace)}/{node.name}"
    what = f"{_mangle(name)}/{dds_type(type_name)}/{type_hash or _NO_HASH}/{qos_text(qos)}"
    return f"{admin}/{domain}/{session}/{node_number}/{number}/{_KINDS[kind]}/{who}/{what}"


def parse_token(token: str) -> NodeInfo | EndpointInfo | None:
    """Parse a liveliness token; return None for others than ROS 2's. Unknown trailing parts are ignored."""
    parts = token.split("/")
    if len(parts) < 9 or parts[0] != _ADMIN:
        return None
    _, domain, session, node_number, _, kind_text, enclave, namespace, name, *rest = parts
    if not (domain.isdecimal() and node_number.isdecimal()):
        return None
    enclave, namespace = _unmangle(enclave), _unmangle(namespace)
    node = NodeInfo(
        token if kind_text == _NODE else node_token(int(domain), session, int(node_number), name, namespace, enclave),
        name,
        namespace,
        enclave,
    )  # fmt: skip
    if kind_text == _NODE:
        return node
    kind = _KINDS_BY_TEXT.get(kind_text)
    if kind is None or len(rest) < 4:
        return None
    topic, type_text, type_hash, qos = rest[:4]
    return EndpointInfo(
        kind,
        node,
        _unmangle(topic),
        ros_type(type_text),
        "" if type_hash == _NO_HASH else type_hash,
        parse_qos(qos),
        gid_of(token),
    )


def session_of(token: str) -> str:
    """Return the zenoh id of the session that declared a token."""
    return "".join(token.split("/", 3)[2:3])


def number_of(token: str) -> int:
    """Return the number of the node or endpoint of a token."""
    return int(token.split("/", 5)[4])


def gid_of(token: str) -> bytes:
    """Return the 16-byte gid of the endpoint of a token."""
    return xxh3_128_intdigest(token.encode()).to_bytes(16, "little")


def qos_text(qos: Qos) -> str:
    """Return a profile in token notation; fields with default values are empty."""
    reliability = "" if qos.reliable else str(int(qos.reliability))
    durability = str(int(qos.durability)) if qos.transient_local else ""
    history = str(int(qos.history)) if qos.history is History.KEEP_ALL else ""
    depth = "" if qos.depth in (0, DEFAULT_DEPTH) else str(qos.depth)
    automatic = qos.liveliness is Liveliness.AUTOMATIC
    liveliness = "" if automatic else str(int(qos.liveliness))
    return (
        f"{reliability}:{durability}:{history},{depth}:{_duration(qos.deadline_ns)}"
        f":{_duration(qos.lifespan_ns)}:{liveliness},{_duration(qos.liveliness_lease_ns)}"
    )


def parse_qos(text: str) -> Qos:
    """Parse the notation of `qos_text`; unreadable fields get their defaults."""
    fields = text.split(":") + [""] * 6
    history, _, depth = fields[2].partition(",")
    liveliness, _, lease = fields[5].partition(",")
    return Qos(
        _member(Reliability.RELIABLE, fields[0]),
        _member(Durability.VOLATILE, fields[1]),
        _member(History.KEEP_LAST, history),
        _number(depth, DEFAULT_DEPTH),
        _parse_duration(fields[3]),
        _parse_duration(fields[4]),
        _member(Liveliness.AUTOMATIC, liveliness),
        _parse_duration(lease),
    )


def _mangle(name: str) -> str:
    return name.replace("/", "%") or "%"


def _unmangle(text: str) -> str:
    return text.replace("%", "/")


def _duration(ns: int) -> str:
    return "," if ns in (0, INFINITE_NS) else f"{ns // _S},{ns % _S}"


def _parse_duration(text: str) -> int:
    seconds, _, ns = text.partition(",")
    if not seconds and not ns:
        return INFINITE_NS
    return min(_number(seconds, 0) * _S + _number(ns, 0), INFINITE_NS)


def _number(text: str, default: int) -> int:
    return int(text) if text.isdecimal() else default


def _member(default: _Policy, text: str) -> _Policy:
    """Return the member of `default`'s enumeration with that number, or `default`."""
    try:
        return type(default)(int(text))
    except ValueError:
        return default
