"""Costmap and footprint of another node, as servers beside it receive them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.pose2 import transform_points
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import NavigationError
from daidalos.nodes.conversions import pose2_of_transform
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import nanoseconds

_FOOTPRINT_TOLERANCE = 0.005
"""Difference [m] of corners, as of rounding and of transforms, that is no other outline."""


class CostmapListener:
    """Subscriptions to the raw topic and the footprint of a costmap.

    Parameters
    ----------
    node : Node
        Subscribes.
    buffer : Buffer
        Transforms of the footprint, which is published where the robot stands.
    base_frame : str
        Frame of the footprint that is kept.
    costmap_topic, footprint_topic : str
    footprint : Footprint
        Outline until one is received.
    on_footprint : callable
        Called with every other outline that is received.

    Attributes
    ----------
    costmap : Costmap or None
        The latest one.
    frame : str
        Its frame.
    footprint : Footprint
        The latest one.
    """

    def __init__(
        self,
        node: Node,
        buffer: Buffer,
        base_frame: str,
        costmap_topic: str,
        footprint_topic: str,
        footprint: Footprint,
        on_footprint: Callable[[Footprint], None] = lambda footprint: None,
    ) -> None:
        from geometry_msgs.msg import PolygonStamped
        from nav2_msgs.msg import Costmap as CostmapMessage

        self.costmap: Costmap | None = None
        self.frame = ""
        self.footprint = footprint
        self._node = node
        self._buffer = buffer
        self._base_frame = base_frame
        self._footprint_topic = footprint_topic
        self._on_other_footprint = on_footprint
        self._updated_ns = 0
        node.create_subscription(CostmapMessage, costmap_topic, self._on_costmap, LATCHED)
        node.create_subscription(PolygonStamped, footprint_topic, self._on_footprint, 1)

    @property
    def age(self) -> float:
        """Time [s] since what the costmap shows was observed; infinite where there is none."""
        if self.costmap is None:
            return float("inf")
        return (self._node.get_clock().now().nanoseconds - self._updated_ns) * 1e-9

    def _on_costmap(self, message: Any) -> None:
        self.costmap, self.frame = costmap_of(message), message.header.frame_id
        stamps = (message.metadata.update_time, message.header.stamp, self._node.get_clock().now().to_msg())
        self._updated_ns = next(filter(None, map(nanoseconds, stamps)), 0)

    def _on_footprint(self, message: Any) -> None:
        try:
            found = self._buffer.lookup_transform(
                self._base_frame, message.header.frame_id, Time.from_msg(message.header.stamp)
            )
        except TransformException:
            return  # another one comes
        corners = np.array([(point.x, point.y) for point in message.polygon.points]).reshape(-1, 2)
        corners = transform_points(pose2_of_transform(found.transform), corners)
        known = self.footprint.polygon
        if corners.shape == known.shape and np.allclose(corners, known, atol=_FOOTPRINT_TOLERANCE):
            return
        try:
            self.footprint = Footprint.of_corners(corners)
        except NavigationError as error:
            self._node.get_logger().warning(f"{self._footprint_topic}: {error}")
            return
        self._on_other_footprint(self.footprint)
