"""Bridges of single topics, in both directions."""

from __future__ import annotations

from typing import Any

from mqtt_client_interfaces.msg import RosMsgType
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.time import Time
from std_msgs.msg import Float64

from daidalos.nodes.message_classes import find_message_class
from daidalos.nodes.mqtt_client import _payloads as payloads
from daidalos.nodes.mqtt_client._connection import Connection
from daidalos.nodes.mqtt_client._parameters import Mqtt2RosParameters, Ros2MqttParameters
from daidalos.nodes.mqtt_client._payloads import PayloadError
from daidalos.nodes.qos import matching_qos

TYPE_PREFIX = "mqtt_client/ros_msg_type/"
"""What precedes an MQTT topic in the topic that announces the type of its messages."""
_SYSTEM = Clock(clock_type=ClockType.SYSTEM_TIME)


class Ros2Mqtt:
    """Bridge from a ROS topic to an MQTT topic; it subscribes as soon as type and quality of service are known.

    Parameters
    ----------
    node : Node
    connection : Connection
    topic : str
        ROS topic.
    settings : Ros2MqttParameters
    """

    def __init__(self, node: Node, connection: Connection, topic: str, settings: Ros2MqttParameters) -> None:
        self._node, self._connection, self._settings = node, connection, settings
        self._topic = node.resolve_topic_name(topic)
        self._type = settings.ros_type
        self._kind: Any = None
        self._subscription: Any = None
        self._is_announced = False

    def update(self) -> None:
        """Subscribe where the graph allows it now, and again where the type of its publishers has changed."""
        infos = self._node.get_publishers_info_by_topic(self._topic)
        settings = self._settings
        is_known = settings.ros_type and "auto" not in (settings.reliability, settings.durability)
        matching = [one for one in infos if not settings.ros_type or one.topic_type == settings.ros_type]
        if self._subscription is not None and (not matching or matching[0].topic_type == self._type):
            return
        if matching:
            self._subscribe(matching[0].topic_type, self._qos(matching))
        elif is_known:
            self._subscribe(settings.ros_type, self._qos([]))

    def announce_again(self) -> None:
        """Announce the type before the next message, since the broker may have forgotten it."""
        self._is_announced = False

    def close(self) -> None:
        """Unsubscribe."""
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None

    def _qos(self, publishers: Any) -> QoSProfile:
        settings = self._settings
        qos = matching_qos(publishers, settings.queue_size)
        if settings.reliability != "auto":
            qos.reliability = ReliabilityPolicy[settings.reliability.upper()]
        if settings.durability != "auto":
            qos.durability = DurabilityPolicy[settings.durability.upper()]
        return qos

    def _subscribe(self, type_name: str, qos: QoSProfile) -> None:
        kind = find_message_class(self._node, type_name)
        if kind is None:
            return
        self.close()
        self._type, self._kind, self._is_announced = type_name, kind, False
        self._subscription = self._node.create_subscription(kind, self._topic, self._send, qos, raw=True)
        self._node.get_logger().info(f"Subscribed ROS topic '{self._topic}' of type '{type_name}'")

    def _send(self, content: bytes) -> None:
        settings = self._settings
        try:
            payload = self._payload(content)
        except PayloadError as problem:
            self._node.get_logger().warning(
                f"Cannot send the message of '{self._topic}': {problem}", throttle_duration_sec=5.0
            )
            return
        if not (settings.primitive or settings.json or self._is_announced):
            announced = RosMsgType(name=self._type, stamped=settings.inject_timestamp)
            topic = f"{TYPE_PREFIX}{settings.mqtt_topic}"
            self._connection.publish(topic, serialize_message(announced), settings.qos, True)
            self._is_announced = True
        self._connection.publish(settings.mqtt_topic, payload, settings.qos, settings.retained)

    def _payload(self, content: bytes) -> bytes:
        if self._settings.primitive:
            return payloads.primitive_text(self._type, deserialize_message(content, self._kind))
        if self._settings.json:
            return payloads.to_json(deserialize_message(content, self._kind))
        if self._settings.inject_timestamp:
            return serialize_message(_SYSTEM.now().to_msg()) + content
        return content


class Mqtt2Ros:
    """Bridge from an MQTT topic to a ROS topic; it publishes as soon as the type is known.

    Parameters
    ----------
    node : Node
    connection : Connection
    topic : str
        MQTT topic.
    settings : Mqtt2RosParameters
    """

    def __init__(self, node: Node, connection: Connection, topic: str, settings: Mqtt2RosParameters) -> None:
        self._node, self._connection, self._topic, self._settings = node, connection, topic, settings
        self._type, self._kind = "", None
        self._is_stamped = False
        self._publisher: Any = None
        self._latencies: Any = None
        if settings.ros_type:
            self._advertise(settings.ros_type)
        is_text = settings.primitive or settings.json
        if not is_text:
            connection.subscribe(f"{TYPE_PREFIX}{topic}", settings.qos)
        if is_text or self._type:
            connection.subscribe(topic, settings.qos)

    def take_type(self, payload: bytes) -> None:
        """Publish messages of the type that a sender announces from now on."""
        try:
            announced = payloads.check_cdr(RosMsgType, payload)
        except PayloadError as problem:
            self._warn(f"{TYPE_PREFIX}{self._topic}", problem)
            return
        if self._settings.ros_type and announced.name != self._settings.ros_type:
            self._node.get_logger().error(
                f"MQTT topic '{self._topic}' has messages of type '{announced.name}', "
                f"the parameter says '{self._settings.ros_type}'"
            )
            return
        self._is_stamped = announced.stamped
        self._advertise(announced.name)
        if self._publisher is not None:
            self._connection.subscribe(self._topic, self._settings.qos)

    def take(self, payload: bytes) -> None:
        """Publish the message of a payload; what is none is refused with a warning."""
        arrived = _SYSTEM.now()
        try:
            message = self._message(payload, arrived)
        except PayloadError as problem:
            self._warn(self._topic, problem)
            return
        if self._publisher is not None:
            self._publisher.publish(message)

    def close(self) -> None:
        """Stop publishing."""
        for publisher in (self._publisher, self._latencies):
            if publisher is not None:
                self._node.destroy_publisher(publisher)
        self._publisher = self._latencies = None

    def _message(self, payload: bytes, arrived: Time) -> Any:
        settings = self._settings
        if settings.primitive:
            self._advertise(settings.ros_type or payloads.primitive_type(payload))
        if self._kind is None:
            raise PayloadError("its type is not known")
        if settings.primitive:
            return payloads.primitive_message(self._kind, self._type, payload)
        if settings.json:
            return payloads.from_json(self._kind, payload)
        if self._is_stamped:
            sent, payload = payloads.split_stamp(payload)
            self._publish_latency((arrived - Time.from_msg(sent, clock_type=ClockType.SYSTEM_TIME)).nanoseconds)
        payloads.check_cdr(self._kind, payload)
        return payload

    def _publish_latency(self, nanoseconds: int) -> None:
        if self._latencies is None:
            topic = f"~/latencies/{self._settings.ros_topic.lstrip('/')}"
            self._latencies = self._node.create_publisher(Float64, topic, 1)
        self._latencies.publish(Float64(data=1e-9 * nanoseconds))

    def _advertise(self, type_name: str) -> None:
        """Publish messages of a type from now on."""
        if type_name == self._type:
            return
        kind = find_message_class(self._node, type_name)
        if kind is None:
            return
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
        self._type, self._kind = type_name, kind
        self._publisher = self._node.create_publisher(kind, self._settings.ros_topic, self._qos())
        self._node.get_logger().info(
            f"ROS publisher message type on topic '{self._settings.ros_topic}' set to '{type_name}'"
        )

    def _qos(self) -> QoSProfile:
        settings = self._settings
        durability = "transient_local" if settings.latched else settings.durability
        return QoSProfile(
            depth=settings.queue_size,
            reliability=ReliabilityPolicy[settings.reliability.upper()],
            durability=DurabilityPolicy[durability.upper()],
        )

    def _warn(self, topic: str, problem: PayloadError) -> None:
        self._node.get_logger().warning(
            f"Cannot publish the message of MQTT topic '{topic}' as ROS topic '{self._settings.ros_topic}': {problem}",
            throttle_duration_sec=1.0,
        )
