"""A goal as its server sees it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.action._goal_state import GoalEvent, GoalState, next_state

if TYPE_CHECKING:
    from rclpy.action.server import ActionServer


class ServerGoalHandle:
    """A goal that a server has accepted."""

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    def __init__(self, action_server: ActionServer, goal_info: Any, goal_request: Any) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._state = GoalState.ACCEPTED
        self._lock = threading.Lock()
        self._destroyed = False
        self.ended_ns: int | None = None
        self._response: Any = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    @property
    def request(self) -> Any:
        """The goal."""
        return self._goal_request

    @property
    def goal_id(self) -> Any:
        """The goal's identity, a ``unique_identifier_msgs/msg/UUID``."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """Whether the goal is not yet over."""
        return not self._destroyed and self._state.is_active

    @property
    def is_cancel_requested(self) -> bool:
        """Whether the goal is to be cancelled."""
        return self._state is GoalState.CANCELING

    @property
    def status(self) -> int:
        """The goal's state, as in ``action_msgs/msg/GoalStatus``."""
        return GoalState.UNKNOWN if self._destroyed else int(self._state)

    def _update_state(self, event: GoalEvent) -> None:
        with self._lock:
            if self._destroyed:
                return
            self._state = next_state(self._state, event)
            if not self._state.is_active:
                self.ended_ns = self._action_server._now_ns()
        self._action_server._publish_status()
        if not self._state.is_active:
            self._action_server.notify_goal_done()

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Execute the goal by a callback, the server's where None.

        Raises
        ------
        RCLError
            When it is carried out already, or over.
        """
        self.executing()
        self._action_server.notify_execute(self, execute_callback)

    def executing(self) -> None:
        """Mark the goal as executing; raise RCLError when it is already, or over."""
        if not self.is_cancel_requested:
            self._update_state(GoalEvent.EXECUTE)

    def publish_feedback(self, feedback: Any) -> None:
        """Publish feedback to the client.

        Raises
        ------
        TypeError
            When the feedback is of the wrong type.
        """
        if not isinstance(feedback, self._action_server.action_type.Feedback):
            raise TypeError(f"Expected {self._action_server.action_type.Feedback}, got {type(feedback)}")
        message = self._action_server.action_type.Impl.FeedbackMessage()
        message.goal_id = self.goal_id
        message.feedback = feedback
        self._action_server._feedback_end.impl.publish(message)

    def succeed(self, response: Any = None) -> None:
        """Complete the goal as succeeded, with a result if it is given here instead of being returned."""
        self._finish(GoalEvent.SUCCEED, response)

    def abort(self, response: Any = None) -> None:
        """Complete the goal as aborted; see `succeed`."""
        self._finish(GoalEvent.ABORT, response)

    def canceled(self, response: Any = None) -> None:
        """Complete the goal as cancelled; see `succeed`."""
        self._finish(GoalEvent.CANCELED, response)

    def _finish(self, event: GoalEvent, response: Any) -> None:
        self._update_state(event)
        self._response = response
        if response is not None:
            self._action_server._set_result(self, response)

    def destroy(self) -> None:
        """Remove the goal."""
        self._destroyed = True
        self._action_server._forget(bytes(self.goal_id.uuid))
