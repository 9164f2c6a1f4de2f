"""Transformation of clouds to the target frame."""

from __future__ import annotations

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2
from tf2_ros import Buffer, TransformException, TransformListener
from tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud


class Frames:
    """Brings clouds into a frame; parameters of the node: ``target_frame`` and ``transform_tolerance`` [s].

    Parameters
    ----------
    node
        Whose parameters and clock they are.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.target = str(node.declare_parameter("target_frame", "").value)
        tolerance = float(node.declare_parameter("transform_tolerance", 0.01).value or 0.0)
        self._tolerance = Duration(seconds=tolerance)
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
