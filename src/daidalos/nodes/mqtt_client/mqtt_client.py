"""`mqtt_client`: sends ROS topics to an MQTT broker and publishes MQTT topics as ROS topics."""

from __future__ import annotations

import threading
from typing import Any

from mqtt_client_interfaces.srv import IsConnected, NewMqtt2RosBridge, NewRos2MqttBridge
from rclpy.node import Node

from daidalos.common.parameters import ParameterError
from daidalos.nodes.mqtt_client._bridges import TYPE_PREFIX, Mqtt2Ros, Ros2Mqtt
from daidalos.nodes.mqtt_client._connection import Connection
from daidalos.nodes.mqtt_client._parameters import Mqtt2RosParameters, MqttClientParameters, Ros2MqttParameters
from daidalos.nodes.parameters import declare, location_of
from daidalos.nodes.runner import UserError


class MqttClient(Node):
    """Node with the bridges of its parameters and of its services."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("mqtt_client", **kwargs)
        settings = declare(self, MqttClientParameters)
        if not settings.client.clean_session and not settings.client.id:
            raise UserError("'client.clean_session: false' needs a 'client.id'")
        if settings.client.buffer_size and not settings.client.id:
            raise UserError("'client.buffer.size' needs a 'client.id'")
        outwards = {one: self._declare(Ros2MqttParameters, "ros2mqtt", one) for one in settings.ros_topics}
        inwards = {one: self._declare(Mqtt2RosParameters, "mqtt2ros", one) for one in settings.mqtt_topics}
        self._lock = threading.RLock()
        self._outwards: dict[str, Ros2Mqtt] = {}
        self._inwards: dict[str, Mqtt2Ros] = {}
        self._look = self.create_guard_condition(self._update)
        self._connection = Connection(
            settings.broker, settings.client, self.get_logger(), self._connected, self._received
        )  # fmt: skip
        for topic, one in outwards.items():
            if one.mqtt_topic:
                self._add_outward(topic, one)
        for topic, entry in inwards.items():
            if entry.ros_topic:
                self._add_inward(topic, entry)
        if not self._outwards and not self._inwards:
            self.get_logger().warning("No bridge is given in the parameters below 'bridge'")
        self.create_service(IsConnected, "~/is_connected", self._answer_is_connected)
        self.create_service(NewRos2MqttBridge, "~/new_ros2mqtt_bridge", self._new_outward)
        self.create_service(NewMqtt2RosBridge, "~/new_mqtt2ros_bridge", self._new_inward)
        # The graph reports changes on its own thread; they are processed in the executor.
        self._stop = self.handle.graph.listen(lambda added, what: self._look.trigger())
        self._look.trigger()

    def destroy_node(self) -> None:
        """Leave the broker and destroy the node."""
        self._stop()
        self._connection.close()
        super().destroy_node()

    def _declare(self, kind: type[Any], direction: str, topic: str) -> Any:
        """Return the parameters of a bridge; one without a target is named and left out."""
        before = f"bridge.{direction}.{topic}"
        settings = declare(self, kind, before)
        target = "mqtt_topic" if kind is Ros2MqttParameters else "ros_topic"
        if not getattr(settings, target):
            self.get_logger().warning(f"Parameter '{before}' is missing subparameter '{target}', will be ignored")
        if settings.json and not settings.primitive and not settings.ros_type:
            problem = f"is needed: '{before}.json' is true"
            raise ParameterError(f"{before}.ros_type", problem, location_of(self, f"{before}.json"))
        if settings.primitive and settings.json:
            self.get_logger().warning(f"'{topic}' is bridged as text, not as JSON: 'primitive' is true as well")
        return settings

    def _add_outward(self, topic: str, settings: Ros2MqttParameters) -> None:
        if settings.inject_timestamp and (settings.primitive or settings.json):
            self.get_logger().warning(f"No time is sent with '{topic}': its messages are text")
        self.get_logger().info(
            f"Bridging {'primitive ' if settings.primitive else ''}ROS topic '{topic}' to MQTT topic "
            f"'{settings.mqtt_topic}'{' as json string' if settings.json and not settings.primitive else ''}"
        )
        with self._lock:
            before = self._outwards.pop(topic, None)
            if before is not None:
                before.close()
            self._outwards[topic] = Ros2Mqtt(self, self._connection, topic, settings)
        self._look.trigger()

    def _add_inward(self, topic: str, settings: Mqtt2RosParameters) -> None:
        self.get_logger().info(
            f"Bridging MQTT topic '{topic}' {'containing json messages ' if settings.json else ''}to "
            f"{'primitive ' if settings.primitive else ''}ROS topic '{settings.ros_topic}'"
        )
        with self._lock:
            before = self._inwards.pop(topic, None)
            if before is not None:
                before.close()
            self._inwards[topic] = Mqtt2Ros(self, self._connection, topic, settings)

    def _update(self) -> None:
        with self._lock:
            for one in self._outwards.values():
                one.update()

    def _connected(self) -> None:
        with self._lock:
            for one in self._outwards.values():
                one.announce_again()

    def _received(self, topic: str, payload: bytes) -> None:
        with self._lock:
            if topic in self._inwards:
                self._inwards[topic].take(payload)
            elif topic.startswith(TYPE_PREFIX) and topic.removeprefix(TYPE_PREFIX) in self._inwards:
                self._inwards[topic.removeprefix(TYPE_PREFIX)].take_type(payload)

    def _answer_is_connected(self, request: Any, response: Any) -> Any:
        response.connected = self._connection.is_connected
        return response

    def _new_outward(self, request: Any, response: Any) -> Any:
        values = {
            "mqtt_topic": request.mqtt_topic, "primitive": request.primitive, "qos": request.mqtt_qos,
            "inject_timestamp": request.inject_timestamp, "queue_size": max(request.ros_queue_size, 1),
            "retained": request.mqtt_retained,
        }  # fmt: skip
        response.success = self._add_asked(request, Ros2MqttParameters, values)
        return response

    def _new_inward(self, request: Any, response: Any) -> Any:
        values = {
            "ros_topic": request.ros_topic, "primitive": request.primitive, "qos": request.mqtt_qos,
            "queue_size": max(request.ros_queue_size, 1), "latched": request.ros_latched,
        }  # fmt: skip
        response.success = self._add_asked(request, Mqtt2RosParameters, values)
        return response

    def _add_asked(self, request: Any, kind: type[Any], values: dict[str, Any]) -> bool:
        """Add the bridge of a service call; return whether its values are allowed."""
        try:
            if not request.ros_topic or not request.mqtt_topic:
                raise ValueError("it needs 'ros_topic' and 'mqtt_topic'")
            settings = kind(**values)
            if kind is Ros2MqttParameters:
                self._add_outward(request.ros_topic, settings)
            else:
                self._add_inward(request.mqtt_topic, settings)
        except ValueError as problem:
            self.get_logger().error(f"the bridge asked for is not possible: {problem}")
            return False
        return True
