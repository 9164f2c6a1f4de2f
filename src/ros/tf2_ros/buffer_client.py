"""Asking another node's buffer for transforms."""

from __future__ import annotations

import time as system_time
import warnings
from typing import TYPE_CHECKING, Any

import tf2_py as tf2
from builtin_interfaces.msg import Time as TimeMessage
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.time import Time
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error

from .buffer_interface import NO_WAIT, BufferInterface

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.node import Node

_PADDING = Duration(seconds=2.0)
_EXCEPTIONS = {
    TF2Error.LOOKUP_ERROR: tf2.LookupException,
    TF2Error.CONNECTIVITY_ERROR: tf2.ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: tf2.ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: tf2.InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: tf2.TimeoutException,
    TF2Error.TRANSFORM_ERROR: tf2.TransformException,
}


class BufferClient(BufferInterface):
    """Client that looks transforms up by a `BufferServer`. Its calls may be made in any callback.

    Parameters
    ----------
    node
        The node to ask with.
    ns
        The name of the server's action.
    check_frequency
        Kept for compatibility: nothing is checked periodically, answers are waited for.
    timeout_padding
        How much longer than the time-out of a look-up to wait for the answer; a number is in seconds.
    """

    def __init__(
        self, node: Node, ns: str, check_frequency: float = 10.0, timeout_padding: Duration | float = _PADDING
    ) -> None:
        super().__init__()
        self.node = node
        self.action_client = ActionClient(node, LookupTransform, action_name=ns)
        self.check_frequency = check_frequency
        self.timeout_padding = (
            timeout_padding if isinstance(timeout_padding, Duration) else Duration(seconds=timeout_padding)
        )

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """Return the transform that takes coordinates in the source frame to the target frame.

        Raises
        ------
        TransformException
            The server's, or a `TimeoutException` when it does not answer.
        """
        return self._ask(
            LookupTransform.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_time_message(time),
                timeout=timeout.to_msg(),
            )
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """Return the transform from the source frame at one time to the target frame at another."""
        return self._ask(
            LookupTransform.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_time_message(source_time),
                timeout=timeout.to_msg(),
                target_time=_time_message(target_time),
                fixed_frame=fixed_frame,
                advanced=True,
            )
        )

    def can_transform(self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NO_WAIT) -> bool:
        """Return whether `lookup_transform` finds the transform."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except tf2.TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> bool:
        """Return whether `lookup_transform_full` finds the transform."""
        try:
            self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        except tf2.TransformException:
            return False
        return True

    def destroy(self) -> None:
        """Destroy the action client."""
        self.action_client.destroy()

    def _ask(self, goal: Any) -> TransformStamped:
        client = self.action_client
        if not client.server_is_ready():
            raise tf2.TimeoutException("The BufferServer is not ready.")
        timeout = Duration.from_msg(goal.timeout) + self.timeout_padding
        end = system_time.monotonic() + timeout.nanoseconds / 1e9
        handle = client._wait(lambda: client.send_goal_async(goal), timeout.nanoseconds / 1e9)
        if handle is None:
            raise _late()
        if not handle.accepted:
            raise tf2.TimeoutException(
                "The LookupTransform goal sent to the BufferServer did not come back with accepted status. "
                "Something is likely wrong with the server."
            )
        # The answer may be on its way just when the padding is over; a moment more does no harm.
        left = max(end - system_time.monotonic(), 1.0)
        response = client._wait(handle.get_result_async, left)
        if response is None:
            raise _late()
        error = response.result.error
        if error.error != TF2Error.NO_ERROR:
            raise _EXCEPTIONS.get(error.error, tf2.TransformException)(error.error_string)
        transform: TransformStamped = response.result.transform
        return transform


def _late() -> tf2.TimeoutException:
    return tf2.TimeoutException(
        "The LookupTransform goal sent to the BufferServer did not come back in the specified time. "
        "Something is likely wrong with the server."
    )


def _time_message(time: Any) -> TimeMessage:
    if isinstance(time, Time):
        message: TimeMessage = time.to_msg()
        return message
    if not isinstance(time, TimeMessage):
        raise TypeError("Must pass a rclpy.time.Time object.")
    warnings.warn(
        "Passing a builtin_interfaces.msg.Time argument is deprecated: use rclpy.time.Time instead.",
        DeprecationWarning,
        stacklevel=4,
    )
    return time
