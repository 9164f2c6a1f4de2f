"""State that checks a condition."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable
from typing import Any

import smach
from rclpy.duration import Duration
from rclpy.node import Node

from smach_ros.ros_state import RosState


class ConditionState(RosState):
    """State that checks a condition again and again: 'true', 'false' when it never holds, or 'preempted'.

    Parameters
    ----------
    node
        See `RosState`.
    cond_cb
        Called with the userdata; returns whether the condition holds.
    input_keys
        Userdata that it reads.
    poll_rate
        Checks per second.
    timeout
        How long to check; without limit where None.
    max_checks
        How often to check at most; -1: without limit.
    """

    def __init__(
        self,
        node: Node,
        cond_cb: Callable[[Any], Any],
        input_keys: Iterable[str] = (),
        poll_rate: float = 20,
        timeout: Duration | None = None,
        max_checks: int = 1,
    ) -> None:
        super().__init__(node, outcomes=["true", "false", "preempted"], input_keys=input_keys)
        self._cond_cb = cond_cb
        declared: Any = cond_cb
        if smach.has_smach_interface(declared):
            self.register_input_keys(declared.get_registered_input_keys())
            self.register_output_keys(declared.get_registered_output_keys())
        self._poll_rate = poll_rate
        self._timeout = timeout
        self._max_checks = max_checks

    def execute(self, ud: Any) -> str:
        """Check the condition."""
        rate = self.node.create_rate(self._poll_rate)
        begin = self.node.get_clock().now()
        checks = 0
        try:
            while self._max_checks == -1 or checks < self._max_checks:
                if self._timeout and self.node.get_clock().now() - begin > self._timeout:
                    return "false"
                if self.preempt_requested():
                    self.service_preempt()
                    return "preempted"
                if self._holds(ud):
                    return "true"
                checks += 1
                if checks != self._max_checks:
                    rate.sleep()
        finally:
            self.node.destroy_rate(rate)
        return "false"

    def _holds(self, ud: Any) -> bool:
        try:
            return bool(self._cond_cb(ud))
        except Exception:  # code of the user's may raise anything
            raise smach.InvalidUserCodeError(
                f"Error thrown while executing condition callback {self._cond_cb}: {traceback.format_exc()}"
            ) from None
