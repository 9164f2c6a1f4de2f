"""`fixed_frame_tf2_broadcaster`: a carrot beside the first turtle."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from daidalos.nodes.turtle_tf2_py._transforms import transform


class FixedFrameTf2Broadcaster(Node):
    """Node that publishes ``carrot1`` two units to the left of ``turtle1``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("fixed_frame_tf2_broadcaster", **kwargs)
        from tf2_ros import TransformBroadcaster

        self._broadcaster = TransformBroadcaster(self)
        self.create_timer(0.1, self._on_timer)

    def _on_timer(self) -> None:
        stamp = self.get_clock().now().to_msg()
        self._broadcaster.sendTransform(transform(stamp, "turtle1", "carrot1", (0.0, 2.0, 0.0)))
