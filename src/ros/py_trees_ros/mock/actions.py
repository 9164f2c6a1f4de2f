"""Action server that lets time pass."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration

Result = Callable[[], Any] | None


class GenericServer:
    """Action server that executes a goal by waiting, publishes feedback, and aborts a goal for a newer one.

    Parameters
    ----------
    node_name, action_name, action_type
        Name of the node, and the action's name and class.
    generate_feedback_message
        Returns the feedback; `percent_completed` says how far the goal is.
    generate_cancelled_result, generate_preempted_result, generate_success_result
        Return the results.
    goal_received_callback
        Called with each goal.
    duration
        How long a goal is executed [s]; a parameter of the node.
    """

    def __init__(
        self,
        node_name: str,
        action_name: str,
        action_type: Any,
        generate_feedback_message: Result = None,
        generate_cancelled_result: Result = None,
        generate_preempted_result: Result = None,
        generate_success_result: Result = None,
        goal_received_callback: Callable[[Any], None] = lambda request: None,
        duration: float | None = None,
    ) -> None:
        self.node = rclpy.create_node(node_name)
        limits = [FloatingPointRange(from_value=0.01, to_value=1e6)]
        descriptor = ParameterDescriptor(description="how long a goal is executed [s]", floating_point_range=limits)
        self.node.declare_parameter("duration", 2.0 if duration is None else duration, descriptor)
        self.duration = self.node.get_parameter("duration").value
        self.frequency = 3.0
        self.percent_completed = 0.0
        self.action_type = action_type
        self.goal_handle: Any = None
        self.goal_lock = threading.Lock()
        self.goal_received_callback = goal_received_callback
        self.generate_feedback_message = generate_feedback_message or action_type.Feedback
        self.generate_cancelled_result = generate_cancelled_result or self._result("goal cancelled")
        self.generate_preempted_result = generate_preempted_result or self._result("goal pre-empted")
        self.generate_success_result = generate_success_result or self._result("goal executed with success")
        self.action_server: Any = ActionServer(
            self.node,
            action_type,
            action_name,
            execute_callback=self.execute_goal_callback,
            goal_callback=self.goal_callback,
            handle_accepted_callback=self.handle_accepted_callback,
            cancel_callback=self.cancel_callback,
            callback_group=ReentrantCallbackGroup(),
        )

    def _result(self, message: str) -> Callable[[], Any]:
        return lambda: self.action_type.Result(message=message)

    def goal_callback(self, goal_request: Any) -> GoalResponse:
        """Accept a goal."""
        self.goal_received_callback(goal_request)
        self.percent_completed = 0.0
        self.duration = self.node.get_parameter("duration").value
        return GoalResponse.ACCEPT

    def cancel_callback(self, goal_handle: Any) -> CancelResponse:
        """Accept that a goal is canceled."""
        return CancelResponse.ACCEPT

    def handle_accepted_callback(self, goal_handle: Any) -> None:
        """Execute a goal, in the place of an older one."""
        with self.goal_lock:
            self.goal_handle = goal_handle
        goal_handle.execute()

    def execute_goal_callback(self, goal_handle: Any) -> Any:
        """Execute a goal."""
        increment = 100.0 / (self.frequency * self.duration)
        while True:
            self.node.get_clock().sleep_for(Duration(seconds=1.0 / self.frequency))
            self.percent_completed = min(100.0, self.percent_completed + increment)
            with self.goal_lock:
                if not goal_handle.is_active:
                    return self.action_type.Result()
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    return self.generate_cancelled_result()
                if goal_handle.goal_id != self.goal_handle.goal_id:
                    goal_handle.abort()
                    return self.generate_preempted_result()
                if self.percent_completed >= 100.0:
                    goal_handle.succeed()
                    return self.generate_success_result()
                goal_handle.publish_feedback(self.generate_feedback_message())

    def abort(self) -> None:
        """Abort the goal that is executed."""
        with self.goal_lock:
            if self.goal_handle is not None and self.goal_handle.is_active:
                self.goal_handle.abort()

    def shutdown(self) -> None:
        """Destroy the server and the node."""
        self.action_server.destroy()
        self.node.destroy_node()
