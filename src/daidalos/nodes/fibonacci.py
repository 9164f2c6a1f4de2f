"""Fibonacci action of the tutorials: one number per second."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node

from daidalos.nodes.cycles import Cycle


class FibonacciServer(Node):
    """Server of the action ``fibonacci``.

    Parameters
    ----------
    name
        The node's.
    action
        The action's class.
    field
        The field of the feedback that has the numbers so far.
    wording
        How the feedback is logged; ``{}`` stands for the numbers.
    """

    def __init__(self, name: str, action: Any, field: str, wording: str, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        from rclpy.action import ActionServer

        self.action = action
        self._field = field
        self._wording = wording
        self.server = ActionServer(
            self,
            action,
            "fibonacci",
            self.execute,
            goal_callback=self.on_goal,
            handle_accepted_callback=self.on_accepted,
            cancel_callback=self.on_cancel,
        )

    def on_goal(self, goal: Any) -> Any:
        """Accept every goal."""
        from rclpy.action import GoalResponse

        return GoalResponse.ACCEPT

    def on_accepted(self, goal_handle: Any) -> None:
        """Execute the goal at once."""
        goal_handle.execute()

    def on_cancel(self, goal_handle: Any) -> Any:
        """Accept every wish to cancel."""
        from rclpy.action import CancelResponse

        return CancelResponse.ACCEPT

    async def execute(self, goal_handle: Any) -> Any:
        """Compute the numbers, and tell of each."""
        self.get_logger().info("Executing goal...")
        feedback = self.action.Feedback()
        sequence = [0, 1]
        with Cycle(self, 1.0) as cycle:
            for index in range(1, goal_handle.request.order):
                if not goal_handle.is_active:  # another goal took its place
                    self.get_logger().info("Goal aborted")
                    return self.action.Result()
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    self.get_logger().info("Goal canceled")
                    return self.action.Result()
                sequence.append(sequence[index] + sequence[index - 1])
                setattr(feedback, self._field, sequence)
                self.get_logger().info(self._wording.format(getattr(feedback, self._field)))
                goal_handle.publish_feedback(feedback)
                await cycle.next()
        if not goal_handle.is_active:
            return self.action.Result()
        goal_handle.succeed()
        return self.finished(self.action.Result(sequence=sequence))

    def finished(self, result: Any) -> Any:
        """Return what a reached goal's result is."""
        return result


class FibonacciClient(Node):
    """Client that sends a goal to ``fibonacci``, and calls `over` at the end; parameters as of `FibonacciServer`."""

    def __init__(self, name: str, action: Any, field: str, over: Callable[[], None], **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        from rclpy.action import ActionClient

        self.over = over
        self._field = field
        self._action = action
        self._client = ActionClient(self, action, "fibonacci")

    def send(self, order: int) -> None:
        """Send a goal; the server must be there."""
        sent = self._client.send_goal_async(self._action.Goal(order=order), feedback_callback=self.on_feedback)
        sent.add_done_callback(self._on_answer)

    def wait_for_server(self) -> None:
        """Wait until there is a server."""
        self._client.wait_for_server()

    def on_feedback(self, message: Any) -> None:
        """Log the numbers so far."""
        self.get_logger().info(f"Received feedback: {getattr(message.feedback, self._field)}")

    def on_accepted(self, goal_handle: Any) -> None:
        """Wait for the result."""
        goal_handle.get_result_async().add_done_callback(lambda answer: self.on_result(answer.result()))

    def on_result(self, answer: Any) -> None:
        """Log the result."""
        from action_msgs.msg import GoalStatus

        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            self.get_logger().info(f"Goal succeeded! Result: {answer.result.sequence}")
        else:
            self.get_logger().info(f"Goal failed with status: {answer.status}")
        self.over()

    def _on_answer(self, answer: Any) -> None:
        goal_handle = answer.result()
        if goal_handle.accepted:
            self.get_logger().info("Goal accepted :)")
            self.on_accepted(goal_handle)
        else:
            self.get_logger().info("Goal rejected :(")
            self.over()


def run_client(make_node: Callable[[Callable[[], None]], FibonacciClient], order: int, *, talkative: bool) -> None:
    """Make a client, send it for numbers, and return when it is done."""
    import rclpy
    from rclpy.task import Future

    rclpy.init()
    over = Future()
    node = make_node(lambda: over.set_result(None))
    try:
        if talkative:
            node.get_logger().info("Waiting for action server...")
        node.wait_for_server()
        if talkative:
            node.get_logger().info("Sending goal request...")
        node.send(order)
        rclpy.spin_until_future_complete(node, over)
    finally:
        node.destroy_node()
