"""State that checks the messages of a topic."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import Any

from rclpy.node import Node

from smach_ros.ros_state import RosState


class MonitorState(RosState):
    """State that lasts while messages fulfil a condition: 'invalid' at the first that does not.

    'valid' is its outcome after `max_checks` messages, and 'preempted' on request.

    Parameters
    ----------
    node
        See `RosState`.
    topic, msg_type
        The topic and the class of its messages.
    cond_cb
        Called with the userdata and a message; returns whether the condition holds.
    max_checks
        Number of messages to check; -1: without limit.
    input_keys, output_keys
        Userdata that `cond_cb` reads and writes.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        msg_type: type,
        cond_cb: Callable[[Any, Any], Any],
        max_checks: int = -1,
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
    ) -> None:
        super().__init__(
            node, outcomes=["valid", "invalid", "preempted"], input_keys=input_keys, output_keys=output_keys
        )
        self._cond_cb = cond_cb
        self._max_checks = max_checks
        self._checks = 0
        self._outcome: str | None = None
        self._ud: Any = None
        self._changed = threading.Condition()
        self._subscription = node.create_subscription(msg_type, topic, self._check, 1)

    def execute(self, ud: Any) -> str:
        """Wait until a message does not fulfil the condition, or enough messages do."""
        with self._changed:
            self._checks, self._outcome, self._ud = 0, None, ud
            self._changed.wait_for(lambda: self._outcome is not None or self.preempt_requested())
            self._ud = None
            outcome = self._outcome
        if outcome is None:
            self.service_preempt()
            return "preempted"
        return outcome

    def _check(self, message: Any) -> None:
        with self._changed:
            if self._ud is None or self._outcome is not None:
                return
            try:
                holds = self._cond_cb(self._ud, message)
            except Exception as error:  # code of the user's may raise anything
                self.node.get_logger().error(
                    f"Error thrown while executing condition callback {self._cond_cb}: {error}"
                )
                holds = False
            self._checks += 1
            if not holds:
                self._outcome = "invalid"
            elif self._checks == self._max_checks:
                self._outcome = "valid"
            self._changed.notify_all()

    def request_preempt(self) -> None:
        """Request that the state ends."""
        super().request_preempt()
        with self._changed:
            self._changed.notify_all()
