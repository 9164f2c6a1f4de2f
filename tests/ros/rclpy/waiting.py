"""Ways to let an executor work until something has happened."""

import time
from collections.abc import Callable

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node

LONG = 30.0
"""Seconds after which a test that waits has failed."""


def executor_of(*nodes: Node) -> SingleThreadedExecutor:
    executor = SingleThreadedExecutor(context=nodes[0].context)
    for node in nodes:
        executor.add_node(node)
    return executor


def spin_until(executor: Executor, condition: Callable[[], object]) -> None:
    """Run callbacks until a condition holds; fail when it takes too long."""
    deadline = time.monotonic() + LONG
    while not condition():
        assert time.monotonic() < deadline, "it did not happen"
        executor.spin_once(timeout_sec=0.05)


def run_ready(executor: Executor, times: int = 20) -> None:
    """Run what is ready now."""
    for _ in range(times):
        executor.spin_once(timeout_sec=0)
