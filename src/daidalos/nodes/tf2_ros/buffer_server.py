"""`buffer_server`: serves transforms by the action ``tf2_buffer_server``, for programs without a buffer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.duration import Duration
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run


@dataclass(frozen=True)
class BufferServerParameters(Parameters):
    """Parameters of ``buffer_server``."""

    buffer_size: float = parameter(120.0, "How long transforms are kept.", unit="s", minimum=0.0)
    check_frequency: float = parameter(10.0, "How often waiting goals are looked at.", unit="Hz", above=0.0)


class BufferServerNode(Node):
    """Server of a transform buffer."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("tf2_buffer_server", **kwargs)
        from tf2_ros import Buffer, BufferServer, TransformListener

        settings = declare(self, BufferServerParameters)
        self._buffer = Buffer(cache_time=Duration(seconds=settings.buffer_size), node=self)
        self._listener = TransformListener(self._buffer, self)
        self._server = BufferServer(
            self._buffer, self, "tf2_buffer_server", Duration(seconds=1.0 / settings.check_frequency)
        )


def main() -> int:
    """Run the node."""
    return run(BufferServerNode)
