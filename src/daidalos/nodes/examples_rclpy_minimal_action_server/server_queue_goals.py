"""`server_queue_goals`: executes one goal after another."""

from __future__ import annotations

from collections import deque
from typing import Any

from daidalos.nodes.examples_rclpy_minimal_action_server.server import MinimalActionServer
from daidalos.nodes.runner import run


class QueueingActionServer(MinimalActionServer):
    """Action server with a queue of goals."""

    def __init__(self, **kwargs: Any) -> None:
        self._queue: deque[Any] = deque()
        self._current: Any = None
        super().__init__(**kwargs)

    def on_accepted(self, goal_handle: Any) -> None:
        """Queue the goal."""
        if self._current is not None:
            self._queue.append(goal_handle)
            self.get_logger().info("Goal put in the queue")
        else:
            self._current = goal_handle
            goal_handle.execute()

    async def execute(self, goal_handle: Any) -> Any:
        """Carry one out, then begin with the next."""
        try:
            return await super().execute(goal_handle)
        finally:
            self._current = self._queue.popleft() if self._queue else None
            if self._current is not None:
                self.get_logger().info("Next goal pulled from the queue")
                self._current.execute()


def main() -> int:
    """Run the node."""
    return run(QueueingActionServer)
