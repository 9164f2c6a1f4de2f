"""`client_cancel`: sends a goal and cancels it after 2 s."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.examples_rclpy_minimal_action_client.client import ORDER, MinimalActionClient
from daidalos.nodes.fibonacci import run_client
from daidalos.nodes.runner import run_program

_CANCEL_AFTER_S = 2.0


class CancellingActionClient(MinimalActionClient):
    """Cancels its goal."""

    def on_accepted(self, goal_handle: Any) -> None:
        """Wait, then cancel."""

        def cancel() -> None:
            self.destroy_timer(timer)
            self.get_logger().info("Canceling goal")
            goal_handle.cancel_goal_async().add_done_callback(lambda answer: self._on_cancelled(answer.result()))

        timer = self.create_timer(_CANCEL_AFTER_S, cancel)

    def _on_cancelled(self, answer: Any) -> None:
        cancelled = bool(answer.goals_canceling)
        self.get_logger().info("Goal successfully canceled" if cancelled else "Goal failed to cancel")
        self.over()


def main() -> int:
    """Request ten numbers and cancel the goal."""
    return run_program(lambda: run_client(CancellingActionClient, ORDER, talkative=True))
