"""`fibonacci_action_server`: computes numbers of the Fibonacci sequence."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.fibonacci import FibonacciServer


class FibonacciActionServer(FibonacciServer):
    """Server of ``action_tutorials_interfaces/action/Fibonacci``."""

    def __init__(self, **kwargs: Any) -> None:
        from action_tutorials_interfaces.action import Fibonacci

        super().__init__("fibonacci_action_server", Fibonacci, "partial_sequence", "Feedback: {}", **kwargs)
