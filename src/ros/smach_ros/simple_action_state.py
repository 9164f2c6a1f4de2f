"""State that sends a goal to an action server and waits for the result."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future

from smach_ros.exchange import ExchangeState, Part

_POLL_S = 0.05
"""How often requests to end and time-outs on the node's clock are checked."""

_MINUTE = Duration(seconds=60.0)


class SimpleActionState(ExchangeState):
    """State that executes an action: 'succeeded', 'aborted', 'preempted', or what `result_cb` returns.

    Parameters
    ----------
    node
        See `RosState`.
    action_name, action_spec
        The action and its class.
    goal
        The goal to begin with; one with default values where None.
    goal_key
        Userdata with the goal.
    goal_slots
        Userdata with fields of the goal, under their names.
    goal_cb, goal_cb_args, goal_cb_kwargs
        Called with the userdata, the goal and these arguments; changes the goal or returns another one.
    result_key, result_slots
        Userdata for the result and for fields of it.
    result_cb, result_cb_args, result_cb_kwargs
        Called with the userdata, the status, the result and these arguments; may return an outcome.
    input_keys, output_keys, outcomes
        Further ones; see `smach.State`.
    exec_timeout
        How long the goal may be executed before it is canceled; without limit where None.
    preempt_timeout
        How long to wait for the result of a goal that is canceled.
    server_wait_timeout
        How long to wait for the server.
    """

    def __init__(
        self,
        node: Node,
        action_name: str,
        action_spec: Any,
        goal: Any = None,
        goal_key: str | None = None,
        goal_slots: Sequence[str] = (),
        goal_cb: Callable[..., Any] | None = None,
        goal_cb_args: Sequence[Any] = (),
        goal_cb_kwargs: Mapping[str, Any] | None = None,
        result_key: str | None = None,
        result_slots: Sequence[str] = (),
        result_cb: Callable[..., Any] | None = None,
        result_cb_args: Sequence[Any] = (),
        result_cb_kwargs: Mapping[str, Any] | None = None,
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        outcomes: Iterable[str] = (),
        exec_timeout: Duration | None = None,
        preempt_timeout: Duration = _MINUTE,
        server_wait_timeout: Duration = _MINUTE,
    ) -> None:
        super().__init__(node, ["succeeded", "aborted", "preempted", *outcomes], input_keys, output_keys)
        self._action_name = action_name
        self._goal = action_spec.Goal() if goal is None else goal
        self._exec_timeout = exec_timeout
        self._preempt_timeout = preempt_timeout
        self._server_wait_timeout = server_wait_timeout
        self._filling = Part(
            self,
            "goal",
            action_spec.Goal,
            key=goal_key,
            slots=goal_slots,
            callback=goal_cb,
            args=goal_cb_args,
            keywords=goal_cb_kwargs,
            is_input=True,
        )
        self._storing = Part(
            self,
            "result",
            action_spec.Result,
            key=result_key,
            slots=result_slots,
            callback=result_cb,
            args=result_cb_args,
            keywords=result_cb_kwargs,
            is_input=False,
        )
        self._client: Any = ActionClient(node, action_spec, action_name)

    def execute(self, ud: Any) -> str:
        """Wait for the server, send the goal and wait for the result."""
        if not self._server_is_there():
            return self._ended()
        goal = self._filling.fill(ud, self._goal)
        if goal is None:
            return "aborted"
        handle = self._wait(self._client.send_goal_async(goal), self._server_wait_timeout)
        if handle is None or not handle.accepted:
            self.node.get_logger().error(f"The goal of action '{self._action_name}' was not accepted")
            return self._ended()
        result = self._wait(handle.get_result_async(), self._exec_timeout, cancel=handle.cancel_goal_async)
        if result is None:
            return self._ended()
        done, outcome = self._storing.store(ud, result.result, result.status)
        if not done:
            return "aborted"
        if outcome is not None:
            return outcome
        if result.status == GoalStatus.STATUS_SUCCEEDED:
            return "succeeded"
        if result.status == GoalStatus.STATUS_CANCELED:
            self.service_preempt()
            return "preempted"
        return self._ended()

    def _ended(self) -> str:
        """Return the outcome of an action without a good result."""
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "aborted"

    def _server_is_there(self) -> bool:
        begin = self.node.get_clock().now()
        while not self._client.wait_for_server(_POLL_S):
            if self.preempt_requested() or not rclpy.ok():
                return False
            if self.node.get_clock().now() - begin > self._server_wait_timeout:
                self.node.get_logger().error(f"There is no server of action '{self._action_name}'")
                return False
        return not self.preempt_requested()

    def _wait(self, future: Future, timeout: Duration | None, cancel: Callable[[], Any] | None = None) -> Any:
        """Return the result of a future; None where it does not come.

        At a request to end, or after `timeout`, the goal is canceled, if it can be, and its result gets
        `preempt_timeout` to arrive.
        """
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        begin, canceled = self.node.get_clock().now(), False
        while not done.wait(_POLL_S):
            elapsed = self.node.get_clock().now() - begin
            if not rclpy.ok() or (canceled and elapsed > self._preempt_timeout):
                return None
            late = timeout is not None and elapsed > timeout
            if not canceled and (late or self.preempt_requested()):
                if late:
                    self.node.get_logger().warning(f"Action '{self._action_name}' timed out")
                if cancel is None:
                    return None
                cancel()
                begin, canceled = self.node.get_clock().now(), True
        return future.result()
