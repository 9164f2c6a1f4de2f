"""Looking transforms up for other nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import tf2_py as tf2
from rclpy.action import ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error

from .buffer_interface import NO_WAIT

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.action.server import ServerGoalHandle
    from rclpy.node import Node
    from rclpy.task import Future

    from .buffer import Buffer

_ERRORS = {
    tf2.LookupException: TF2Error.LOOKUP_ERROR,
    tf2.ConnectivityException: TF2Error.CONNECTIVITY_ERROR,
    tf2.ExtrapolationException: TF2Error.EXTRAPOLATION_ERROR,
    tf2.InvalidArgumentException: TF2Error.INVALID_ARGUMENT_ERROR,
    tf2.TimeoutException: TF2Error.TIMEOUT_ERROR,
}


class BufferServer:
    """Server of the action by which a `BufferClient` requests transforms.

    Parameters
    ----------
    buffer
        Where to look them up.
    node
        The node to serve with; it must be spun.
    ns
        The name of the action.
    check_period
        Kept for compatibility: nothing is checked periodically, transforms are waited for.
    """

    def __init__(self, buffer: Buffer, node: Node, ns: str, check_period: Duration = NO_WAIT) -> None:
        self.buffer = buffer
        self.node = node
        self._group = ReentrantCallbackGroup()
        self.action_server = ActionServer(
            node, LookupTransform, ns, execute_callback=self._execute, callback_group=self._group
        )

    def destroy(self) -> None:
        """Stop serving."""
        self.action_server.destroy()

    async def _execute(self, goal_handle: ServerGoalHandle) -> Any:
        result = LookupTransform.Result()
        try:
            result.transform = await self._look_up(goal_handle.request)
        except tf2.TransformException as error:
            result.error.error = _ERRORS.get(type(error), TF2Error.TRANSFORM_ERROR)
            result.error.error_string = str(error)
            goal_handle.abort()
        else:
            goal_handle.succeed()
        return result

    async def _look_up(self, goal: Any) -> TransformStamped:
        buffer = self.buffer
        asked: tuple[Any, ...]
        wait: Callable[..., Future]
        look_up: Callable[..., TransformStamped]
        if goal.advanced:
            asked = (goal.target_frame, goal.target_time, goal.source_frame, goal.source_time, goal.fixed_frame)
            wait, look_up = buffer.wait_for_transform_full_async, buffer.lookup_transform_full_core
        else:
            asked = (goal.target_frame, goal.source_frame, goal.source_time)
            wait, look_up = buffer.wait_for_transform_async, buffer.lookup_transform_core
        future = wait(*asked)
        seconds = Duration.from_msg(goal.timeout).nanoseconds / 1e9
        if seconds > 0.0 and not future.done():
            timer = self.node.create_timer(seconds, future.cancel, callback_group=self._group)
            await future
            self.node.destroy_timer(timer)
        future.cancel()
        return look_up(*asked)
