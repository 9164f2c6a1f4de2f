"""`server_single_goal`: a new goal aborts the previous one."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.examples_rclpy_minimal_action_server.server import MinimalActionServer
from daidalos.nodes.runner import run


class SingleGoalActionServer(MinimalActionServer):
    """Action server that executes only the latest goal."""

    def __init__(self, **kwargs: Any) -> None:
        self._current: Any = None
        super().__init__(**kwargs)

    def on_accepted(self, goal_handle: Any) -> None:
        """Abort the previous goal and execute the new one."""
        if self._current is not None and self._current.is_active:
            self.get_logger().info("Aborting previous goal")
            self._current.abort()
        self._current = goal_handle
        goal_handle.execute()


def main() -> int:
    """Run the node."""
    return run(SingleGoalActionServer)
