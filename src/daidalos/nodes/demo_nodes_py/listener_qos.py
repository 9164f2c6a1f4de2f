"""`listener_qos`: subscribes to ``chatter``, reliably or best effort."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.demo_nodes_py._quality import parse, profile
from daidalos.nodes.hello_world import HelloListener
from daidalos.nodes.runner import run_program


class ListenerQos(HelloListener):
    """Logs each sentence."""

    def __init__(self, reliable: bool = False, **kwargs: Any) -> None:
        super().__init__("listener_qos", "chatter", "I heard: [{}]", qos=profile(reliable), **kwargs)
        self.get_logger().info("Reliable listener" if reliable else "Best effort listener")


def main() -> int:
    """Run the node for a number of messages."""
    arguments = parse("Hears what is published on chatter, reliably or not.", "max number of spin_once iterations")

    def body() -> None:
        import rclpy

        rclpy.init()
        node = ListenerQos(arguments.reliable)
        try:
            while node.received_count < arguments.number_of_cycles:
                rclpy.spin_once(node)
        finally:
            node.destroy_node()

    return run_program(body)
