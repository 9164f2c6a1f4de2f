"""Topics by which types of docks see docks, batteries and wheels."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.pose3 import Pose
from daidalos.navigation.docking.contracts import DockType
from daidalos.samples.fields import seconds


class DockListener:
    """Subscriptions of one type of docks.

    Parameters
    ----------
    node : Node
    dock : DockType
    buffer : Buffer
        Transforms of docks that are seen.
    frame : str
        Fixed frame.
    """

    def __init__(self, node: Node, dock: DockType, buffer: Buffer, frame: str) -> None:
        from geometry_msgs.msg import PoseStamped
        from sensor_msgs.msg import BatteryState, JointState

        self._node = node
        self._dock = dock
        self._buffer = buffer
        self._frame = frame
        self._seen: Any = None
        if dock.detection_topic:
            node.create_subscription(PoseStamped, dock.detection_topic, self._on_detection, 1)
        if dock.battery_topic:
            node.create_subscription(BatteryState, dock.battery_topic, lambda one: dock.take_battery(one.current), 1)
        if dock.joint_topic:
            node.create_subscription(
                JointState, dock.joint_topic, lambda one: dock.take_joints(one.name, one.velocity, one.effort), 1
            )

    def _on_detection(self, message: Any) -> None:
        self._seen = message

    def update(self) -> None:
        """Pass the latest detection on, once its transform has come."""
        seen = self._seen
        if seen is None:
            return
        try:
            frame = seen.header.frame_id or self._frame
            found = self._buffer.lookup_transform(self._frame, frame, Time.from_msg(seen.header.stamp)).transform
        except TransformException as error:
            self._node.get_logger().warning(f"the dock's pose is not used: {error}", throttle_duration_sec=1.0)
            return
        self._seen = None
        self._dock.take_detection(_pose(found.translation, found.rotation) @ _pose_of(seen.pose), _stamp(seen))


def _stamp(message: Any) -> float:
    return seconds(message.header.stamp)


def _pose_of(pose: Any) -> Pose:
    return _pose(pose.position, pose.orientation)


def _pose(position: Any, orientation: Any) -> Pose:
    return Pose((position.x, position.y, position.z), (orientation.x, orientation.y, orientation.z, orientation.w))
