"""Navigation to the pose before a dock."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.node import Node

from daidalos.navigation.errors import FailedToStage
from daidalos.nodes.cycles import Cycle

_TRIES = 2
_SERVER_TIMEOUT_S = 2.0
"""How long [s] the navigator may take to appear and to answer."""


class Navigator:
    """Client of ``navigate_to_pose``.

    Parameters
    ----------
    node : Node
    behavior_tree : str
        File of the tree that is used; empty for the navigator's own.
    """

    def __init__(self, node: Node, behavior_tree: str) -> None:
        self._node = node
        self._behavior_tree = behavior_tree
        from nav2_msgs.action import NavigateToPose

        self._client = ActionClient(node, NavigateToPose, "navigate_to_pose")

    async def go_to(self, pose: Any, timeout: float, cycle: Cycle, is_over: Callable[[], bool]) -> None:
        """Drive to a ``PoseStamped``, with a second try; return early where the goal is over.

        Raises
        ------
        FailedToStage
            It was not reached, or not within the timeout [s].
        """
        deadline = self._now + timeout
        reason = ""
        for _ in range(_TRIES):
            reason = await self._try(pose, deadline, cycle, is_over)
            if not reason or is_over():
                return
        raise FailedToStage(f"the staging pose was not reached: {reason}")

    async def _try(self, pose: Any, deadline: float, cycle: Cycle, is_over: Callable[[], bool]) -> str:
        """Drive to a pose; return why it was not reached, an empty string where it was."""
        from nav2_msgs.action import NavigateToPose

        latest = min(deadline, self._now + _SERVER_TIMEOUT_S)
        while not self._client.server_is_ready():
            if self._now > latest or is_over():
                return "the action navigate_to_pose is not served"
            await cycle.next()
        sent = self._client.send_goal_async(NavigateToPose.Goal(pose=pose, behavior_tree=self._behavior_tree))
        while not sent.done():  # also after a cancellation: a goal that is on its way must be taken back
            await cycle.next()
        handle = sent.result()
        if handle is None or not handle.accepted:
            return "navigate_to_pose rejected it"
        ended = handle.get_result_async()
        while not ended.done():
            if is_over() or self._now > deadline:
                handle.cancel_goal_async()
                if is_over():
                    return "the goal is over"
                raise FailedToStage("the staging pose was not reached in time")
            await cycle.next()
        answer = ended.result()
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return ""
        return answer.result.error_msg or "navigate_to_pose did not succeed"

    @property
    def _now(self) -> float:
        return self._node.get_clock().now().nanoseconds * 1e-9
