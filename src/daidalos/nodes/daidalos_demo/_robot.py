"""Client of the demonstration's navigation stack: its actions and services."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable
from typing import Any

from rclpy.node import Node
from rclpy.task import Future

from daidalos.nodes.conversions import pose_stamped
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import duration_message

_POLL_S = 0.25
_TURN_LIMIT_S = 30.0
_RUNNING = (1, 2)  # accepted and executing, of action_msgs/msg/GoalStatus


class Robot:
    """Client that sends the robot to goals.

    Parameters
    ----------
    node : Node
        To speak with; its executor has to run.
    """

    def __init__(self, node: Node) -> None:
        from action_msgs.msg import GoalStatusArray
        from nav2_msgs.action import NavigateToPose, Spin
        from nav_msgs.msg import OccupancyGrid
        from rclpy.action import ActionClient
        from std_srvs.srv import Trigger

        self._node = node
        self.map: Any = None
        self._has_goal = False
        node.create_subscription(OccupancyGrid, "/map", self._on_map, LATCHED)
        node.create_subscription(GoalStatusArray, "navigate_to_pose/_action/status", self._on_status, LATCHED)
        self._navigator = ActionClient(node, NavigateToPose, "navigate_to_pose")
        self._spinner = ActionClient(node, Spin, "spin")
        self._is_active = node.create_client(Trigger, "/lifecycle_manager_navigation/is_active")

    def _on_map(self, message: Any) -> None:
        self.map = message

    def _on_status(self, message: Any) -> None:
        self._has_goal = any(status.status in _RUNNING for status in message.status_list)

    async def until_ready(self, also: Callable[[], bool] = lambda: True) -> None:
        """Wait until there is a map, the stack is active and `also` holds."""
        await self._until(lambda: self._is_ready(also))

    async def _is_ready(self, also: Callable[[], bool]) -> bool:
        from std_srvs.srv import Trigger

        if self.map is None or not also() or not self._is_active.service_is_ready():
            return False
        answer = await self._is_active.call_async(Trigger.Request())
        return bool(answer.success) and self._navigator.server_is_ready() and self._spinner.server_is_ready()

    async def _until(self, condition: Callable[[], Awaitable[bool]]) -> None:
        while not await condition():
            await self.pause(_POLL_S)

    async def until_mapped(self, x: float, y: float, limit_s: float) -> None:
        """Wait until the map reaches as far as a place, but no longer than a limit."""
        for _ in range(round(limit_s / _POLL_S)):
            if self.map is not None and _is_within(self.map, x, y):
                return
            await self.pause(_POLL_S)

    async def pause(self, seconds: float) -> None:
        """Wait for some seconds of a steady clock."""
        from rclpy.clock import Clock
        from rclpy.clock_type import ClockType

        over = Future()
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        timer = self._node.create_timer(seconds, lambda: over.set_result(None), clock=clock)
        await over
        self._node.destroy_timer(timer)

    async def look_around(self) -> None:
        """Turn once, so that the map shows what was behind the robot; a goal from anyone ends it."""
        from nav2_msgs.action import Spin

        allowance = duration_message(_TURN_LIMIT_S)
        handle = await self._spinner.send_goal_async(Spin.Goal(target_yaw=2.0 * math.pi, time_allowance=allowance))
        if not handle.accepted:
            return
        ended = handle.get_result_async()
        while not ended.done() and not self._has_goal:
            await self.pause(0.1)
        if not ended.done():
            await handle.cancel_goal_async()
        await ended

    async def drive(self, goal: Any, limit_s: float) -> tuple[bool, str]:
        """Drive to a pose (x, y, yaw) on the map; returns whether it was reached, and why not."""
        from action_msgs.msg import GoalStatus
        from nav2_msgs.action import NavigateToPose

        stamp = self._node.get_clock().now().to_msg()
        handle = await self._navigator.send_goal_async(NavigateToPose.Goal(pose=pose_stamped(goal, "map", stamp)))
        if not handle.accepted:
            return False, "the goal was rejected"
        limit = self._node.create_timer(limit_s, lambda: handle.cancel_goal_async())
        answer = await handle.get_result_async()
        self._node.destroy_timer(limit)
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return True, ""
        return False, answer.result.error_msg or f"it ended with status {answer.status}"


def _is_within(grid: Any, x: float, y: float) -> bool:
    """Return whether a place is on a map, whose axes are those of its frame."""
    info = grid.info
    column = (x - info.origin.position.x) / info.resolution
    row = (y - info.origin.position.y) / info.resolution
    return bool(0.0 <= column < info.width and 0.0 <= row < info.height)
