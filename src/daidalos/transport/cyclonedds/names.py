"""Names, types and user data in the notation of rmw_cyclonedds."""

from __future__ import annotations

from importlib import import_module

from daidalos.transport.dds_types import ros_type
from daidalos.transport.graph import EndpointKind

DISCOVERY_TOPIC = "ros_discovery_info"
DISCOVERY_TYPE = "rmw_dds_common/msg/ParticipantEntitiesInfo"
_TOPIC, _REQUEST, _REPLY = "rt", "rq", "rr"


def topic_of(name: str) -> str:
    """Return the DDS name of a topic: ``/chatter`` -> ``rt/chatter``."""
    return f"{_TOPIC}{name}"


def request_topic_of(name: str) -> str:
    """Return the DDS topic of a service's requests: ``/add`` -> ``rq/addRequest``."""
    return f"{_REQUEST}{name}Request"


def reply_topic_of(name: str) -> str:
    """Return the DDS topic of a service's replies: ``/add`` -> ``rr/addReply``."""
    return f"{_REPLY}{name}Reply"


def parse_endpoint(topic: str, type_name: str, writes: bool) -> tuple[EndpointKind, str, str] | None:
    """Return the ROS endpoint of a DDS topic and type.

    Returns
    -------
    (kind, name, type) or None
        A service is known by the reader of its requests, a client by their writer. None for what serves the
        middleware itself, and for the side of a service that carries replies.
    """
    prefix, slash, rest = topic.partition("/")
    if prefix == _TOPIC and slash:
        return EndpointKind.PUBLISHER if writes else EndpointKind.SUBSCRIPTION, f"/{rest}", ros_type(type_name)
    if prefix == _REQUEST and rest.endswith("Request"):
        kind = EndpointKind.CLIENT if writes else EndpointKind.SERVICE
        return kind, f"/{rest.removesuffix('Request')}", ros_type(type_name).removesuffix("_Request")
    return None


def parts_of_service(type_name: str) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return (type, hash) of a service's request and response; the hashes are empty if its class is not found."""
    package, kind, name = type_name.split("/")
    service = getattr(import_module(f"{package}.{kind}"), name, None)
    request, response = getattr(service, "Request", None), getattr(service, "Response", None)
    return (
        (f"{type_name}_Request", getattr(request, "_TYPE_HASH", "")),
        (f"{type_name}_Response", getattr(response, "_TYPE_HASH", "")),
    )


def discovery_type_hash() -> str:
    """Return the type hash of `ros_discovery_info`, which ROS 2 expects of its endpoints as of all others."""
    from rmw_dds_common.msg import ParticipantEntitiesInfo

    type_hash: str = ParticipantEntitiesInfo._TYPE_HASH
    return type_hash


def write_user_data(**values: str) -> bytes:
    """Return ``key=value;`` pairs as text, without those that have no value."""
    return "".join(f"{key}={value};" for key, value in values.items() if value).encode()


def read_user_data(data: bytes) -> dict[str, str]:
    """Return ``key=value;`` pairs as a dict; malformed pairs are ignored."""
    pairs = (part.partition("=") for part in data.decode("utf-8", "replace").split(";"))
    return {key.strip(): value.strip() for key, separator, value in pairs if separator}


def dotted(identity: bytes) -> str:
    """Return an identity as ``01.10.8c...``."""
    return ".".join(f"{byte:02x}" for byte in identity)
