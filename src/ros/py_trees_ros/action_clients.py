"""Behaviours that execute actions."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from typing import Any

import py_trees
from action_msgs.msg import GoalStatus
from py_trees.common import Access, Status
from rclpy.action import ActionClient
from rclpy.node import Node

from py_trees_ros import exceptions
from py_trees_ros.publishers import node_of

_STATUS_NAMES = {
    getattr(GoalStatus, f"STATUS_{name}"): f"STATUS_{name}"
    for name in ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
}


class FromBlackboard(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Behaviour that executes an action with a goal of the blackboard.

    It is RUNNING until there is a result, FAILURE without a goal, when the goal is rejected and when the action does
    not succeed. It cancels the goal when it is interrupted.

    Parameters
    ----------
    name
        Name of the behaviour.
    action_type, action_name
        The action's class and its name.
    key
        The variable with the goal.
    generate_feedback_message
        Returns the behaviour's feedback message of one from the server.
    wait_for_server_timeout_sec
        How long `setup` waits for the server [s]; 0: not at all, negative: without limit.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        key: str,
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        super().__init__(name)
        self.action_type = action_type
        self.action_name = action_name
        self.wait_for_server_timeout_sec = wait_for_server_timeout_sec
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard.register_key(
            key="goal", access=Access.READ, remap_to=py_trees.blackboard.Blackboard.absolute_name("/", key)
        )
        self.generate_feedback_message = generate_feedback_message
        self.node: Node | None = None
        self.action_client: Any = None
        self._forget()

    def _forget(self) -> None:
        self.goal_handle: Any = None
        self.send_goal_future: Any = None
        self.get_result_future: Any = None
        self.result_message: Any = None
        self.result_status: int | None = None
        self.result_status_string: str | None = None

    def setup(self, **kwargs: Any) -> None:
        """Create the client on the given ``node``, and wait for the server.

        Raises
        ------
        exceptions.TimedOutError
            When there is no server in time.
        """
        self.node = node_of(self, kwargs)
        self.action_client = ActionClient(self.node, self.action_type, self.action_name)
        limit = self.wait_for_server_timeout_sec
        if limit > 0.0:
            found = self.action_client.wait_for_server(limit)
        else:
            found = limit == 0.0 or self._wait_without_limit(-limit)
        if not found:
            self.feedback_message = f"timed out waiting for the server [{self.action_name}]"
            self.node.get_logger().error(f"{self.feedback_message}[{self.qualified_name}]")
            raise exceptions.TimedOutError(self.feedback_message)
        self.feedback_message = "... connected to action server" if limit else "no wait for the action server"

    def _wait_without_limit(self, period: float) -> bool:
        assert self.node is not None
        while self.node.context.ok():
            if self.action_client.wait_for_server(period):
                return True
            self.node.get_logger().warning(f"waiting for action server ... [{self.action_name}][{self.qualified_name}]")
        return False

    def initialise(self) -> None:
        """Send the goal."""
        self._forget()
        try:
            goal = self.blackboard.goal
        except KeyError:
            return  # which `update` notices
        self.send_goal_request(goal)

    def update(self) -> Status:
        """Check for the result."""
        if self.send_goal_future is None:
            self.feedback_message = "no goal to send"
            return Status.FAILURE
        if self.goal_handle is not None and not self.goal_handle.accepted:
            self.feedback_message = "goal rejected"
            return Status.FAILURE
        if self.send_goal_future.done() and self.goal_handle is None:
            self.feedback_message = "goal request failed"
            return Status.FAILURE
        if self.result_status is None:
            return Status.RUNNING
        if self.result_status == GoalStatus.STATUS_SUCCEEDED:
            self.feedback_message = "successfully completed"
            return Status.SUCCESS
        self.feedback_message = "failed"
        return Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """Cancel the goal if the behaviour is interrupted."""
        if self.status == Status.RUNNING and new_status == Status.INVALID:
            self.send_cancel_request()

    def shutdown(self) -> None:
        """Destroy the client."""
        if self.action_client is not None:
            self.action_client.destroy()

    def feedback_callback(self, msg: Any) -> None:
        """Take feedback of the server over into the behaviour's feedback message."""
        if self.generate_feedback_message is not None:
            self.feedback_message = f"feedback: {self.generate_feedback_message(msg)}"

    def send_goal_request(self, goal: Any) -> None:
        """Send a goal."""
        self.feedback_message = "sent goal request"
        self.send_goal_future = self.action_client.send_goal_async(goal, feedback_callback=self.feedback_callback)
        self.send_goal_future.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future: Any) -> None:
        """Ask for the result of an accepted goal."""
        if future.exception() is not None or future.result() is None:
            self.feedback_message = f"goal request failed [{future.exception()!r}]"
            return
        self.goal_handle = future.result()
        if not self.goal_handle.accepted:
            self.feedback_message = "goal rejected"
            return
        self.feedback_message = "goal accepted"
        self.get_result_future = self.goal_handle.get_result_async()
        self.get_result_future.add_done_callback(self.get_result_callback)

    def send_cancel_request(self) -> None:
        """Cancel the goal."""
        self.feedback_message = f"cancelling goal ... [{self.qualified_name}]"
        if self.goal_handle is not None and self.goal_handle.accepted:
            self.goal_handle.cancel_goal_async().add_done_callback(self.cancel_response_callback)

    def cancel_response_callback(self, future: Any) -> None:
        """Record whether the goal is canceled."""
        canceled = bool(future.result().goals_canceling)
        self.feedback_message = "goal successfully cancelled" if canceled else "goal failed to cancel"

    def get_result_callback(self, future: Any) -> None:
        """Take over the result."""
        self.result_message = future.result()
        self.result_status = self.result_message.status
        self.result_status_string = _STATUS_NAMES.get(self.result_message.status, "STATUS_UNKNOWN")


class FromConstant(FromBlackboard):
    """Behaviour that executes an action with a fixed goal.

    Parameters
    ----------
    name, action_type, action_name, generate_feedback_message, wait_for_server_timeout_sec
        See `FromBlackboard`.
    action_goal
        The goal.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        action_goal: Any,
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        key = f"/goal_{uuid.uuid4()}"
        super().__init__(name, action_type, action_name, key, generate_feedback_message, wait_for_server_timeout_sec)
        self.blackboard.register_key(key=key, access=Access.WRITE)
        self.blackboard.set(name=key, value=action_goal)
