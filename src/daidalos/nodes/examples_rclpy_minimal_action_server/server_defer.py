"""`server_defer`: executes a goal some time after its acceptance."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.examples_rclpy_minimal_action_server.server import MinimalActionServer
from daidalos.nodes.runner import run

_DELAY_S = 3.0


class DeferringActionServer(MinimalActionServer):
    """Action server that defers its goals."""

    def on_accepted(self, goal_handle: Any) -> None:
        """Schedule the execution."""
        self.get_logger().info("Deferring execution...")

        def begin() -> None:
            self.destroy_timer(timer)
            goal_handle.execute()

        timer = self.create_timer(_DELAY_S, begin)


def main() -> int:
    """Run the node."""
    return run(DeferringActionServer)
