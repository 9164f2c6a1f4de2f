"""`dynamic_frame_tf2_broadcaster`: a carrot that circles the first turtle."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node

from daidalos.nodes.turtle_tf2_py._transforms import transform

_RADIUS = 10.0


class DynamicFrameTf2Broadcaster(Node):
    """Node that publishes ``carrot1`` on a circle around ``turtle1``, with a period of two seconds."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("dynamic_frame_tf2_broadcaster", **kwargs)
        from tf2_ros import TransformBroadcaster

        self._broadcaster = TransformBroadcaster(self)
        self.create_timer(0.1, self._on_timer)

    def _on_timer(self) -> None:
        now = self.get_clock().now()
        angle = math.pi * (now.nanoseconds % 2_000_000_000) * 1e-9
        place = (_RADIUS * math.sin(angle), _RADIUS * math.cos(angle), 0.0)
        self._broadcaster.sendTransform(transform(now.to_msg(), "turtle1", "carrot1", place))
