"""Information in the graph about a topic's publisher or subscription."""

from __future__ import annotations

import copy
from enum import IntEnum
from typing import Any

from daidalos.transport.graph import EndpointInfo, EndpointKind
from rclpy.qos import QoSProfile, qos_profile_unknown
from rclpy.type_hash import TypeHash


class TopicEndpointTypeEnum(IntEnum):
    """Kinds of endpoints, with rmw's values."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


_DEFAULTS: dict[str, Any] = {
    "node_name": "",
    "node_namespace": "",
    "topic_type": "",
    "topic_type_hash": None,
    "endpoint_type": TopicEndpointTypeEnum.INVALID,
    "endpoint_gid": [],
    "qos_profile": None,
}


class TopicEndpointInfo:
    """A publisher or subscription: its node, type, kind, gid (list of 16 integers) and QoS profile."""

    __slots__ = (
        "_endpoint_gid",
        "_endpoint_type",
        "_node_name",
        "_node_namespace",
        "_qos_profile",
        "_topic_type",
        "_topic_type_hash",
    )  # fmt: skip

    def __init__(self, **kwargs: Any) -> None:
        unknown = kwargs.keys() - _DEFAULTS.keys()
        assert not unknown, f"Invalid arguments passed to constructor: {unknown}"
        values = {**_DEFAULTS, **kwargs}
        self.node_name = values["node_name"]
        self.node_namespace = values["node_namespace"]
        self.topic_type = values["topic_type"]
        self.topic_type_hash = TypeHash() if values["topic_type_hash"] is None else values["topic_type_hash"]
        self.endpoint_type = values["endpoint_type"]
        self.endpoint_gid = list(values["endpoint_gid"])
        profile = values["qos_profile"]
        self.qos_profile = copy.copy(qos_profile_unknown) if profile is None else profile

    @classmethod
    def from_endpoint(cls, endpoint: EndpointInfo) -> TopicEndpointInfo:
        """Return the description of an endpoint in the graph."""
        is_publisher = endpoint.kind is EndpointKind.PUBLISHER
        return cls(
            node_name=endpoint.node.name,
            node_namespace=endpoint.node.namespace,
            topic_type=endpoint.type_name,
            topic_type_hash=TypeHash.from_text(endpoint.type_hash),
            endpoint_type=TopicEndpointTypeEnum.PUBLISHER if is_publisher else TopicEndpointTypeEnum.SUBSCRIPTION,
            endpoint_gid=list(endpoint.gid),
            qos_profile=QoSProfile.from_resolved(endpoint.qos),
        )

    @property
    def node_name(self) -> str:
        """Name of the endpoint's node."""
        return self._node_name

    @node_name.setter
    def node_name(self, value: str) -> None:
        assert isinstance(value, str)
        self._node_name = value

    @property
    def node_namespace(self) -> str:
        """Namespace of the endpoint's node."""
        return self._node_namespace

    @node_namespace.setter
    def node_namespace(self, value: str) -> None:
        assert isinstance(value, str)
        self._node_namespace = value

    @property
    def topic_type(self) -> str:
        """Type of the topic's messages."""
        return self._topic_type

    @topic_type.setter
    def topic_type(self, value: str) -> None:
        assert isinstance(value, str)
        self._topic_type = value

    @property
    def topic_type_hash(self) -> TypeHash:
        """Hash of the type."""
        return self._topic_type_hash

    @topic_type_hash.setter
    def topic_type_hash(self, value: TypeHash | dict[str, Any]) -> None:
        self._topic_type_hash = TypeHash(**value) if isinstance(value, dict) else value
        assert isinstance(self._topic_type_hash, TypeHash)

    @property
    def endpoint_type(self) -> TopicEndpointTypeEnum:
        """Publisher or subscription."""
        return self._endpoint_type

    @endpoint_type.setter
    def endpoint_type(self, value: TopicEndpointTypeEnum | int) -> None:
        assert isinstance(value, (TopicEndpointTypeEnum, int))
        self._endpoint_type = TopicEndpointTypeEnum(value)

    @property
    def endpoint_gid(self) -> list[int]:
        """The endpoint's identity."""
        return self._endpoint_gid

    @endpoint_gid.setter
    def endpoint_gid(self, value: list[int]) -> None:
        assert all(isinstance(item, int) for item in value)
        self._endpoint_gid = value

    @property
    def qos_profile(self) -> QoSProfile:
        """The endpoint's quality of service."""
        return self._qos_profile

    @qos_profile.setter
    def qos_profile(self, value: QoSProfile | dict[str, Any]) -> None:
        self._qos_profile = QoSProfile(**value) if isinstance(value, dict) else value
        assert isinstance(self._qos_profile, QoSProfile)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TopicEndpointInfo):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        gid = ".".join(f"{number:02x}" for number in self.endpoint_gid)
        qos = self.qos_profile
        history = qos.history.name
        if qos.history.name == "KEEP_LAST":
            history += f" ({qos.depth})"
        return "\n".join(
            (
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {gid}",
                "QoS profile:",
                f"  Reliability: {qos.reliability.name}",
                f"  History (Depth): {history}",
                f"  Durability: {qos.durability.name}",
                f"  Lifespan: {qos.lifespan}",
                f"  Deadline: {qos.deadline}",
                f"  Liveliness: {qos.liveliness.name}",
                f"  Liveliness lease duration: {qos.liveliness_lease_duration}",
            )
        )
