"""`static_turtle_tf2_broadcaster`: a turtle that never moves."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.node import Node

from daidalos.nodes.runner import program_arguments, run
from daidalos.nodes.turtle_tf2_py._transforms import transform

_USAGE = """Invalid number of parameters. Usage:
$ ros2 run turtle_tf2_py static_turtle_tf2_broadcaster child_frame_name x y z roll pitch yaw"""


class StaticTurtleTf2Broadcaster(Node):
    """Node that publishes a static frame in ``world``."""

    def __init__(self, name: str, numbers: list[float], **kwargs: Any) -> None:
        super().__init__("static_turtle_tf2_broadcaster", **kwargs)
        from tf2_ros import StaticTransformBroadcaster

        self._broadcaster = StaticTransformBroadcaster(self)
        stamp = self.get_clock().now().to_msg()
        self._broadcaster.sendTransform(transform(stamp, "world", name, numbers[:3], numbers[3:]))


def main() -> int:
    """Run the node."""
    words = program_arguments()
    try:
        name, numbers = words[0], [float(word) for word in words[1:]]
    except (IndexError, ValueError):
        name, numbers = "", []
    if len(numbers) != 6:
        print(_USAGE, file=sys.stderr)
        return 1
    if name == "world":
        print('Your static turtle name cannot be "world"', file=sys.stderr)
        return 2
    return run(lambda: StaticTurtleTf2Broadcaster(name, numbers))
