"""`server`: executes all goals concurrently."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.fibonacci import FibonacciServer
from daidalos.nodes.runner import run


class MinimalActionServer(FibonacciServer):
    """Server of ``example_interfaces/action/Fibonacci``."""

    def __init__(self, **kwargs: Any) -> None:
        from example_interfaces.action import Fibonacci

        super().__init__("minimal_action_server", Fibonacci, "sequence", "Publishing feedback: {}", **kwargs)

    def on_goal(self, goal: Any) -> Any:
        """Accept every goal."""
        self.get_logger().info("Received goal request")
        return super().on_goal(goal)

    def on_cancel(self, goal_handle: Any) -> Any:
        """Accept every wish to cancel."""
        self.get_logger().info("Received cancel request")
        return super().on_cancel(goal_handle)

    def finished(self, result: Any) -> Any:
        """Log the result before it is sent."""
        self.get_logger().info(f"Returning result: {result.sequence}")
        return result


def main() -> int:
    """Run the node."""
    return run(MinimalActionServer)
