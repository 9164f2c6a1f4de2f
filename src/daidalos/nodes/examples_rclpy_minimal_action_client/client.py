"""`client`: sends a goal and waits for its result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.nodes.fibonacci import FibonacciClient, run_client
from daidalos.nodes.runner import run_program

ORDER = 10


class MinimalActionClient(FibonacciClient):
    """Client that sends a goal of ``example_interfaces/action/Fibonacci``."""

    def __init__(self, over: Callable[[], None], **kwargs: Any) -> None:
        from example_interfaces.action import Fibonacci

        super().__init__("minimal_action_client", Fibonacci, "sequence", over, **kwargs)


def main() -> int:
    """Request ten numbers."""
    return run_program(lambda: run_client(MinimalActionClient, ORDER, talkative=True))
