"""`buffer_server`: serves transforms by the action ``tf2_buffer_server``, for programs without a buffer."""

from __future__ import annotations

from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node

from daidalos.nodes.runner import run


class BufferServerNode(Node):
    """Server of a transform buffer; parameters: ``buffer_size`` [s], ``check_frequency`` [1/s]."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("tf2_buffer_server", **kwargs)
        from tf2_ros import Buffer, BufferServer, TransformListener

        size = float(self.declare_parameter("buffer_size", 120.0).value or 0.0)
        frequency = float(self.declare_parameter("check_frequency", 10.0).value or 0.0)
        self._buffer = Buffer(cache_time=Duration(seconds=size), node=self)
        self._listener = TransformListener(self._buffer, self)
        self._server = BufferServer(self._buffer, self, "tf2_buffer_server", Duration(seconds=1.0 / frequency))


def main() -> int:
    """Run the node."""
    return run(BufferServerNode)
