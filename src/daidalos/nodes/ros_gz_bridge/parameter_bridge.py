"""`parameter_bridge`: checks that what is to be bridged can be, and renames topics where the sides differ."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.utilities import remove_ros_args

from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.ros_gz_bridge._mapping import (
    Bridge,
    MappingError,
    parse_arguments,
    read_file,
    simulator_topic,
)
from daidalos.nodes.runner import UserError, run

_OVERRIDABLE = (QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY)


class ParameterBridge(Node):
    """A bridge whose two sides are the same graph.

    Topics of the simulator are topics of ROS already: where both sides have one name there is nothing to
    do but to check types. Where a remapping or a file gives the ROS side another name, messages are passed on.

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
        path = str(self.declare_parameter("config_file", "").value)
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
        for bridge in bridges:
            self._connect(bridge)
        for service in services:
            self.get_logger().info(f"service {service} is in the graph already")
        self._gz_thread = NodeThread(self._gz_side)

    def _connect(self, bridge: Bridge) -> None:
        ros = self.resolve_topic_name(bridge.ros_topic)
        gz = simulator_topic(bridge.gz_topic)
        if ros == gz:
            self.get_logger().info(f"{gz} ({bridge.ros_type}) needs no bridge")
            return
        package, _, name = bridge.ros_type.partition("/msg/")
        kind = getattr(import_module(f"{package}.msg"), name)
        overrides = QoSOverridingOptions(_OVERRIDABLE)
        own: set[bytes] = set()
        if bridge.direction != "ROS_TO_GZ":
            outward = self.create_publisher(kind, bridge.ros_topic, 10, qos_overriding_options=overrides)
            own.add(outward.handle.endpoint.gid)
            self._gz_side.create_subscription(kind, gz, _forwarding_callback(outward, own), 10)
        if bridge.direction != "GZ_TO_ROS":
            inward = self._gz_side.create_publisher(kind, gz, 10)
            own.add(inward.handle.endpoint.gid)
            take = _forwarding_callback(inward, own)
            self.create_subscription(kind, bridge.ros_topic, take, 10, qos_overriding_options=overrides)
        self.get_logger().info(f"{gz} is {ros} ({bridge.ros_type}, {bridge.direction})")

    def destroy_node(self) -> None:
        """Leave the graph on both sides."""
        self._gz_thread.stop()
        self._gz_side.destroy_node()
        super().destroy_node()


def _forwarding_callback(publisher: Any, own: set[bytes]) -> Callable[[Any, Any], None]:
    """Return a callback that says on one side what it heard on the other, but for what this bridge said itself."""

    def take(message: Any, info: Any) -> None:
        if info["publisher_gid"]["data"] not in own:
            publisher.publish(message)

    return take


def main() -> int:
    """Run the node."""
    return run(lambda: ParameterBridge(remove_ros_args(sys.argv)[1:]))


if __name__ == "__main__":
    sys.exit(main())
