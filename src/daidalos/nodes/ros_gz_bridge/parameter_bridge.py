"""`parameter_bridge`: connects topics with different names or types on the simulator's and ROS's sides."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import rclpy
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind
from rclpy.qos_overriding_options import QoSOverridingOptions

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.parameters import declare
from daidalos.nodes.ros_gz_bridge._conversions import Converter, find_converter, message_class
from daidalos.nodes.ros_gz_bridge._mapping import (
    Bridge,
    MappingError,
    parse_arguments,
    read_file,
    simulator_topic,
)
from daidalos.nodes.runner import UserError, program_arguments, run
from daidalos.transport.graph import EndpointInfo, EndpointKind

_OVERRIDABLE = (QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY)


@dataclass(frozen=True)
class ParameterBridgeParameters(Parameters):
    """Parameters of ``parameter_bridge``."""

    config_file: str = parameter("", "YAML file that names topics to bridge; none where empty.")


class ParameterBridge(Node):
    """Bridge whose two sides are the same graph.

    Topics of the simulator are topics of ROS already: where name and type are the same on both sides nothing is to
    be done. Where a remapping or a file gives the ROS side another name, messages are forwarded. Where the simulator
    publishes or subscribes another ROS type of the same type of gz (TwistStamped is bridged, and the simulator takes
    Twist), messages are converted from the moment at which that endpoint appears in the graph.

    Parameters
    ----------
    words : list of str
        ``topic@ros_type@gz_type``; the parameter ``config_file`` may name more.

    Raises
    ------
    UserError
    """

    def __init__(self, words: list[str], **kwargs: Any) -> None:
        super().__init__("ros_gz_bridge", **kwargs)
        path = declare(self, ParameterBridgeParameters).config_file
        try:
            bridges, services = parse_arguments(words)
            if path:
                more_bridges, more_services = read_file(Path(path))
                bridges, services = bridges + more_bridges, services + more_services
        except MappingError as error:
            raise UserError(str(error)) from None
        if not bridges and not services:
            self.get_logger().warning("there is nothing to bridge: neither arguments nor a config_file name a topic")
        # Names of the simulator's side are not to be remapped.
        self._gz_side = rclpy.create_node(
            "ros_gz_bridge_gz", use_global_arguments=False, start_parameter_services=False
        )
        self._found: deque[tuple[Bridge, EndpointInfo]] = deque()
        self._connected: set[tuple[Bridge, str, EndpointKind]] = set()
        self._own: set[bytes] = set()
        self._connecting = self._gz_side.create_guard_condition(self._connect_found)
        self._unwatch = [self._connect(bridge) for bridge in bridges]
        for service in services:
            self.get_logger().info(f"service {service} is in the graph already")
        self._gz_thread = NodeThread(self._gz_side)

    def _connect(self, bridge: Bridge) -> Callable[[], None]:
        """Forward a topic between its two names, and watch for endpoints of other types; return what ends that."""
        ros = self.resolve_topic_name(bridge.ros_topic)
        gz = simulator_topic(bridge.gz_topic)
        if ros == gz:
            self.get_logger().info(f"{gz} ({bridge.ros_type}) has one name on both sides")
        else:
            if bridge.direction != "ROS_TO_GZ":
                self._forward_to_ros(bridge, bridge.ros_type)
            if bridge.direction != "GZ_TO_ROS":
                self._forward_to_gz(bridge, bridge.ros_type)
            self.get_logger().info(f"{gz} is {ros} ({bridge.ros_type}, {bridge.direction})")

        def watch(added: bool, endpoint: EndpointInfo) -> None:
            if added and endpoint.type_name != bridge.ros_type and endpoint.gid not in self._own:
                self._found.append((bridge, endpoint))
                self._connecting.trigger()

        return self._gz_side.handle.session.watch(gz, watch)

    def _connect_found(self) -> None:
        """Convert for the endpoints of other types that appeared."""
        while self._found:
            bridge, endpoint = self._found.popleft()
            key = (bridge, endpoint.type_name, endpoint.kind)
            if key in self._connected or endpoint.gid in self._own:
                continue
            gz = simulator_topic(bridge.gz_topic)
            if endpoint.kind is EndpointKind.PUBLISHER and bridge.direction != "ROS_TO_GZ":
                convert = find_converter(endpoint.type_name, bridge.ros_type, self._now)
                if convert is not None:
                    self._connected.add(key)
                    self._forward_to_ros(bridge, endpoint.type_name, convert)
                    self.get_logger().info(f"{gz}: converting {endpoint.type_name} to {bridge.ros_type}")
            elif endpoint.kind is EndpointKind.SUBSCRIPTION and bridge.direction != "GZ_TO_ROS":
                convert = find_converter(bridge.ros_type, endpoint.type_name, self._now)
                if convert is not None:
                    self._connected.add(key)
                    self._forward_to_gz(bridge, endpoint.type_name, convert)
                    self.get_logger().info(f"{gz}: converting {bridge.ros_type} to {endpoint.type_name}")

    def _now(self) -> Any:
        return self.get_clock().now().to_msg()

    def _forward_to_ros(self, bridge: Bridge, gz_side_type: str, convert: Converter | None = None) -> None:
        overrides = QoSOverridingOptions(_OVERRIDABLE) if convert is None else None
        on_other_type = self._on_other_type(bridge, convert)
        publisher = self.create_publisher(
            message_class(bridge.ros_type),
            bridge.ros_topic,
            10,
            qos_overriding_options=overrides,
            event_callbacks=PublisherEventCallbacks(incompatible_type=on_other_type),
        )
        self._own.add(publisher.handle.endpoint.gid)
        take = _forwarding_callback(publisher, self._own, convert)
        subscription = self._gz_side.create_subscription(
            message_class(gz_side_type),
            simulator_topic(bridge.gz_topic),
            take,
            10,
            event_callbacks=SubscriptionEventCallbacks(incompatible_type=on_other_type),
        )
        self._own.add(subscription.handle.endpoint.gid)

    def _forward_to_gz(self, bridge: Bridge, gz_side_type: str, convert: Converter | None = None) -> None:
        overrides = QoSOverridingOptions(_OVERRIDABLE) if convert is None else None
        on_other_type = self._on_other_type(bridge, convert)
        publisher = self._gz_side.create_publisher(
            message_class(gz_side_type),
            simulator_topic(bridge.gz_topic),
            10,
            event_callbacks=PublisherEventCallbacks(incompatible_type=on_other_type),
        )
        self._own.add(publisher.handle.endpoint.gid)
        take = _forwarding_callback(publisher, self._own, convert)
        subscription = self.create_subscription(
            message_class(bridge.ros_type),
            bridge.ros_topic,
            take,
            10,
            qos_overriding_options=overrides,
            event_callbacks=SubscriptionEventCallbacks(incompatible_type=on_other_type),
        )
        self._own.add(subscription.handle.endpoint.gid)

    def _on_other_type(self, bridge: Bridge, convert: Converter | None) -> Callable[[Any], None] | None:
        """Return what to do about another type on a topic: a warning, or nothing where two types share one name."""
        if convert is None or self.resolve_topic_name(bridge.ros_topic) != simulator_topic(bridge.gz_topic):
            return None
        return lambda _: None

    def destroy_node(self) -> None:
        """Destroy the node, and its publishers and subscriptions on both sides."""
        for unwatch in self._unwatch:
            unwatch()
        self._gz_thread.stop()
        self._gz_side.destroy_node()
        super().destroy_node()


def _forwarding_callback(publisher: Any, own: set[bytes], convert: Converter | None) -> Callable[[Any, Any], None]:
    """Return a callback that publishes on one side what came from the other, except for the bridge's own messages."""

    def take(message: Any, info: Any) -> None:
        if info["publisher_gid"]["data"] not in own:
            publisher.publish(message if convert is None else convert(message))

    return take


def main() -> int:
    """Run the node."""
    return run(lambda: ParameterBridge(program_arguments()))
