"""A graph of this process alone, for tests that need nodes: `from ros.graph import graph, node  # noqa: F401`."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node


@pytest.fixture
def graph(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """The default context, begun without a wire."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    rclpy.init(args=[])
    context = rclpy.get_default_context()
    try:
        yield context
    finally:
        rclpy.try_shutdown()
        context.destroy()  # and with it every node that the test left behind


@pytest.fixture
def node(graph: Context) -> Iterator[Node]:
    """A node in that graph."""
    node = rclpy.create_node("tested")
    yield node
    node.destroy_node()


@contextmanager
def spinning(*nodes: Node) -> Iterator[SingleThreadedExecutor]:
    """Spin nodes in another thread meanwhile."""
    executor = SingleThreadedExecutor()
    for node in nodes:
        executor.add_node(node)

    def spin() -> None:
        with suppress(ExternalShutdownException):  # the test may end the context
            executor.spin()

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield executor
    finally:
        executor.shutdown()
        thread.join()


def after(seconds: float, action: Callable[[], None]) -> threading.Timer:
    """Do something later, in another thread."""
    timer = threading.Timer(seconds, action)
    timer.start()
    return timer
