"""Goals of actions for clients."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from rclpy.action import ActionClient
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.task import Future

from rosbridge_library.internal.message_conversion import extract_values, populate_instance
from rosbridge_library.internal.ros_loader import get_action_class
from rosbridge_library.internal.waiting import named_values, when

SERVER_TIMEOUT_S = 1.0
"""Time in which an action's server must be reached."""


class InvalidActionException(Exception):
    """Error of an action that does not exist."""

    def __init__(self, action_name: str) -> None:
        super().__init__(f"Action {action_name} does not exist")


class SendGoal:
    """One goal, from its request to its result.

    Parameters
    ----------
    server_timeout_time
        Time in which the action's server must be reached, in seconds.
    sleep_time
        Without effect: the result is not polled for.
    """

    def __init__(self, server_timeout_time: float = SERVER_TIMEOUT_S, sleep_time: float = 0.001) -> None:
        self.server_timeout_time = server_timeout_time
        self.goal_handle: Any = None
        self.goal_canceled = False
        self._cancel_wanted = False
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._client: ActionClient | None = None
        self._tell: Callable[[Any], Any] = lambda _: None

    def begin(
        self,
        node_handle: Node,
        action: str,
        action_type: str,
        args: Any,
        feedback_cb: Callable[[Any], Any] | None,
        ended: Callable[[dict[str, Any] | Exception], Any],
    ) -> None:
        """Send the goal and return at once; `ended` gets the result as values for JSON, or the error."""
        self._tell = ended
        try:
            name = expand_topic_name(action, node_handle.get_name(), node_handle.get_namespace())
            kind = get_action_class(action_type)
            goal = kind.Goal()
            args_to_action_goal_instance(name, goal, args)
            client = self._client = ActionClient(node_handle, kind, name)
        except Exception as error:
            self._end(error)
            return

        def send() -> None:
            try:
                sent = client.send_goal_async(goal, feedback_callback=feedback_cb)
            except Exception as error:
                self._end(error)
            else:
                sent.add_done_callback(self._answered)

        when(client.server_is_ready, self.server_timeout_time, send, lambda: self._end(InvalidActionException(name)))

    def send_goal(
        self,
        node_handle: Node,
        action: str,
        action_type: str,
        args: Any = None,
        feedback_cb: Callable[[Any], Any] | None = None,
    ) -> dict[str, Any]:
        """Send the goal, wait for its result, and return it as values for JSON; another thread must spin the node."""
        results: list[Any] = []
        self.begin(node_handle, action, action_type, args, feedback_cb, results.append)
        self._ended.wait()
        if isinstance(results[0], Exception):
            raise results[0]
        values: dict[str, Any] = results[0]
        return values

    def cancel_goal(self) -> None:
        """Ask the server to cancel the goal, as soon as it has accepted it."""
        with self._lock:
            self._cancel_wanted = True
            if self.goal_handle is None:
                return
        self.goal_handle.cancel_goal_async().add_done_callback(self._cancelled)

    def _cancelled(self, _: Future) -> None:
        self.goal_canceled = True

    def _answered(self, future: Future) -> None:
        try:
            handle = future.result()
            if not handle.accepted:
                raise RuntimeError("Action goal was rejected")
        except Exception as error:
            self._end(error)
            return
        with self._lock:
            self.goal_handle = handle
            cancel = self._cancel_wanted
        handle.get_result_async().add_done_callback(self._finished)
        if cancel:
            self.cancel_goal()

    def _finished(self, future: Future) -> None:
        try:
            result: dict[str, Any] | Exception = extract_values(future.result())
        except Exception as error:
            result = error
        self._end(result)

    def _end(self, result: dict[str, Any] | Exception) -> None:
        if self._client is not None:
            self._client.destroy()
        self._tell(result)
        self._ended.set()


class ActionClientHandler:
    """Goal whose end is told to callbacks.

    Parameters
    ----------
    action, action_type
        Name and type of the action.
    args
        Values of the goal: by field, or a list in the order of the fields.
    success_callback, error_callback, feedback_callback
        Called with status and result as values for JSON, with the error, and with each feedback message.
    node_handle
        Node that sends; it must be spun.
    """

    def __init__(
        self,
        action: str,
        action_type: str,
        args: Any,
        success_callback: Callable[[dict[str, Any]], Any],
        error_callback: Callable[[Exception], Any],
        feedback_callback: Callable[[Any], Any] | None,
        node_handle: Node,
    ) -> None:
        self.action = action
        self.action_type = action_type
        self.args = args
        self.success = success_callback
        self.error = error_callback
        self.feedback = feedback_callback
        self.node_handle = node_handle
        self.send_goal_helper = SendGoal()
        self._ended = threading.Event()

    def start(self) -> None:
        """Send the goal; returns at once."""
        self.send_goal_helper.begin(
            self.node_handle, self.action, self.action_type, self.args, self.feedback, self._end
        )

    def run(self) -> None:
        """Send the goal and wait for its result."""
        self.start()
        self.join()

    def join(self) -> None:
        """Wait for the result of a goal that was sent."""
        self._ended.wait()

    def _end(self, result: dict[str, Any] | Exception) -> None:
        self._ended.set()
        if isinstance(result, Exception):
            self.error(result)
        else:
            self.success(result)


def args_to_action_goal_instance(action: str, inst: Any, args: Any) -> None:
    """Set fields of a goal from values by field, or in the order of the fields."""
    populate_instance(named_values(inst.get_fields_and_field_types(), args), inst)
