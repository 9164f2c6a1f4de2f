"""`fibonacci_action_client`: requests numbers of the Fibonacci sequence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.nodes.fibonacci import FibonacciClient, run_client
from daidalos.nodes.runner import run_program

_ORDER = 10


class FibonacciActionClient(FibonacciClient):
    """Client of ``action_tutorials_interfaces/action/Fibonacci``."""

    def __init__(self, over: Callable[[], None], **kwargs: Any) -> None:
        from action_tutorials_interfaces.action import Fibonacci

        super().__init__("fibonacci_action_client", Fibonacci, "partial_sequence", over, **kwargs)

    def on_result(self, answer: Any) -> None:
        """Log the result."""
        self.get_logger().info(f"Result: {answer.result.sequence}")
        self.over()


def main() -> int:
    """Request ten numbers."""
    return run_program(lambda: run_client(FibonacciActionClient, _ORDER, talkative=False))
