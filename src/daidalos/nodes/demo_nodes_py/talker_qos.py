"""`talker_qos`: publishes on ``chatter``, reliably or best effort."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.demo_nodes_py._quality import parse, profile
from daidalos.nodes.hello_world import HelloTalker
from daidalos.nodes.runner import run_program


class TalkerQos(HelloTalker):
    """Node that publishes a sentence every second."""

    def __init__(self, reliable: bool = False, **kwargs: Any) -> None:
        super().__init__("talker_qos", "chatter", 1.0, 'Publishing: "{}"', qos=profile(reliable), **kwargs)
        self.get_logger().info("Reliable talker" if reliable else "Best effort talker")


def main() -> int:
    """Run the node for a number of messages."""
    arguments = parse("Publishes on chatter, reliably or not.", "number of sending attempts")

    def body() -> None:
        import rclpy

        rclpy.init()
        node = TalkerQos(arguments.reliable)
        try:
            while node.number < arguments.number_of_cycles:
                rclpy.spin_once(node)
        finally:
            node.destroy_node()

    return run_program(body)
