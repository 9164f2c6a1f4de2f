"""Transformation of clouds to the target frame."""

from __future__ import annotations

from dataclasses import dataclass

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2
from tf2_ros import Buffer, TransformException, TransformListener
from tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare


@dataclass(frozen=True)
class FramesParameters(Parameters):
    """Common parameters of the nodes that transform clouds."""

    target_frame: str = parameter("", "Frame of the output; that of the input where empty.")
    transform_tolerance: float = parameter(0.01, "How long to wait for a transform.", unit="s", minimum=0.0)


class Frames:
    """Brings clouds into a frame.

    Parameters
    ----------
    node
        Whose parameters and clock they are.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        settings = declare(node, FramesParameters)
        self.target = settings.target_frame
        self._tolerance = Duration(seconds=settings.transform_tolerance)
        if self.target:
            self._buffer = Buffer(node=node)
            self._listener = TransformListener(self._buffer, node, spin_thread=True)

    def transform_cloud(self, cloud: PointCloud2) -> PointCloud2 | None:
        """Return a cloud in the target frame, or as it is where none is wanted; None where that is not known."""
        if not self.target or cloud.header.frame_id == self.target:
            return cloud
        try:
            transform = self._buffer.lookup_transform(
                self.target, cloud.header.frame_id, Time.from_msg(cloud.header.stamp), self._tolerance
            )
        except TransformException as error:
            self._node.get_logger().warning(f"Transform failure: {error}", throttle_duration_sec=5.0)
            return None
        return do_transform_cloud(cloud, transform)
