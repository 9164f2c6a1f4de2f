"""The end of the time for which an action server keeps results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.action.server import ActionServer
    from rclpy.node import Node


class Expiry:
    """Timer that wakes the server when the oldest result has been kept long enough."""

    def __init__(self, server: ActionServer, node: Node) -> None:
        self._server = server
        self._rcl_node = node
        self._timer: Any = None

    def plan(self) -> None:
        """Wait for the next result to expire."""
        server = self._server
        if server._result_timeout < 0 or server._destroyed:
            return
        with server._lock:
            ended = [goal.ended_ns for goal in server._goal_handles.values() if goal.ended_ns is not None]
            if not ended:
                return
            left = min(ended) + int(server._result_timeout * 1e9) - server._now_ns()
        self.close()
        self._timer = self._rcl_node.create_timer(max(left, 0) / 1e9, self._expire, server.callback_group)

    def _expire(self) -> None:
        self.close()
        self._server.expire_goals()

    def close(self) -> None:
        """Wait no more."""
        timer, self._timer = self._timer, None
        if timer is not None:
            self._rcl_node.destroy_timer(timer)
