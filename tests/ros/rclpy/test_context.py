"""Contexts: begun and ended, and nothing of them left behind."""

import gc
import os
import signal
import subprocess
import sys
import threading
import weakref
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
import rclpy
from rclpy.context import Context
from rclpy.exceptions import NotInitializedException
from rclpy.impl.errors import InvalidHandle, RCLError
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions, get_current_signal_handlers_options
from std_msgs.msg import String
from std_srvs.srv import Empty

from ros.rclpy.waiting import executor_of, run_ready


@pytest.fixture(autouse=True)
def without_a_wire(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")


def furnished(context: Context) -> Node:
    node = Node("tested", context=context)
    node.create_subscription(String, "chatter", lambda _: None, 10)
    node.create_publisher(String, "chatter", 10)
    node.create_client(Empty, "work")
    node.create_service(Empty, "work", lambda _, response: response)
    node.create_timer(0.001, lambda: None)
    return node


def test_a_context_ends_once() -> None:
    context = Context()
    assert not context.ok()
    rclpy.init(args=[], context=context)
    assert context.ok()
    with pytest.raises(RuntimeError, match="once"):
        rclpy.init(args=[], context=context)
    rclpy.shutdown(context=context)
    assert not context.ok()
    with pytest.raises(RuntimeError):
        rclpy.shutdown(context=context)
    context.try_shutdown()


def test_a_context_begins_and_ends_with_its_block() -> None:
    with Context() as context:
        assert context.ok()
        assert Node("tested", context=context).get_name() == "tested"
    assert not context.ok()


def test_init_ends_with_its_block() -> None:
    with rclpy.init(args=[], domain_id=77) as begun:
        assert begun.context.get_domain_id() == 77
        assert get_current_signal_handlers_options() == SignalHandlerOptions.ALL
    assert not begun.context.ok()
    assert get_current_signal_handlers_options() == SignalHandlerOptions.NO


def test_a_negative_domain_is_refused() -> None:
    with pytest.raises(RuntimeError, match="zero"):
        rclpy.init(args=[], domain_id=-1)


def test_what_is_no_ros_argument_is_named() -> None:
    from rclpy.impl.implementation_singleton import rclpy_implementation

    with pytest.raises(rclpy_implementation.UnknownROSArgsError, match="unknown"):
        rclpy.init(context=Context(), args=["--ros-args", "unknown"])


def test_nothing_can_be_made_before_and_after() -> None:
    context = Context()
    with pytest.raises(NotInitializedException):
        Node("early", context=context)
    with context:
        node = Node("tested", context=context)
    with pytest.raises(NotInitializedException):
        Node("late", context=context)
    with pytest.raises(RCLError, match="shut down"):
        node.create_publisher(String, "chatter", 10)


@pytest.mark.slow
def test_who_asked_for_it_is_told_of_the_end_and_not_kept_alive_by_that() -> None:
    class Listener:
        def __init__(self) -> None:
            self.told = 0

        def tell(self) -> None:
            self.told += 1

    listener, forgotten = Listener(), Listener()
    gone = weakref.ref(forgotten)
    with Context() as context:
        context.on_shutdown(listener.tell)
        context.on_shutdown(forgotten.tell)
        del forgotten
        gc.collect()
        assert gone() is None
    assert listener.told == 1
    context.on_shutdown(listener.tell)
    assert listener.told == 2, "it has ended already, and so is told at once"
    with pytest.raises(TypeError):
        context.on_shutdown(7)


def test_nodes_leave_the_graph_with_their_context() -> None:
    for _ in range(3):
        rclpy.init(args=[])
        node = furnished(rclpy.get_default_context())
        assert node.count_subscribers("chatter") == 1
        assert node.count_services("work") == 1
        rclpy.shutdown()


def test_a_context_leaves_the_nodes_of_another_one_alone() -> None:
    with Context() as first, Context() as second:
        stays, goes = furnished(first), furnished(second)
        assert stays.count_publishers("chatter") == 2
        second.shutdown()
        assert stays.get_node_names() == ["tested"]
        assert stays.count_publishers("chatter") == stays.count_services("work") == 1
        goes.destroy_node()  # as programs do, in whatever order


def test_what_is_used_after_the_end_does_no_harm() -> None:
    with Context() as context:
        node = furnished(context)
    publisher = next(one for one in node.publishers if one.msg_type is String)
    publisher.publish(String(data="to nobody"))
    node.get_logger().info("still here")
    node.destroy_node()
    with pytest.raises(InvalidHandle):
        node.get_name()


@pytest.mark.slow
def test_a_node_that_is_dropped_leaves_the_graph() -> None:
    with Context() as context:
        watcher = Node("watcher", context=context)
        node = furnished(context)
        node.itself = node  # so that only the garbage collector finds it
        executor = executor_of(node)
        run_ready(executor, 3)
        executor.remove_node(node)
        gone = weakref.ref(node)
        del node
        gc.collect()
        assert gone() is None
        graph = watcher.handle.graph
        assert graph.wait_for(lambda: watcher.get_node_names() == ["watcher"], 10)
        assert graph.wait_for(lambda: watcher.count_subscribers("chatter") == watcher.count_services("work") == 0, 10)


MAKERS: dict[str, Callable[[Node], Callable[[], object]]] = {
    "publisher": lambda node: _undo(node.destroy_publisher, node.create_publisher(String, "chatter", 10)),
    "subscription": lambda node: _undo(
        node.destroy_subscription, node.create_subscription(String, "chatter", print, 10)
    ),
    "client": lambda node: _undo(node.destroy_client, node.create_client(Empty, "work")),
    "service": lambda node: _undo(node.destroy_service, node.create_service(Empty, "work", print)),
    "timer": lambda node: _undo(node.destroy_timer, node.create_timer(1000.0, print)),
    "guard": lambda node: _undo(node.destroy_guard_condition, node.create_guard_condition(print)),
    "rate": lambda node: _undo(node.destroy_rate, node.create_rate(1.0)),
}


def _undo(destroy: Callable[[object], object], entity: object) -> Callable[[], object]:
    return lambda: destroy(entity)


@pytest.mark.slow
@pytest.mark.parametrize("kind", MAKERS)
def test_entities_that_come_and_go_leave_nothing(kind: str) -> None:
    with Context() as context:
        node = Node("tested", context=context)
        executor = executor_of(node)

        def once() -> None:
            assert MAKERS[kind](node)()
            run_ready(executor, 2)

        for _ in range(50):
            once()
        gc.collect()
        before = len(gc.get_objects())
        for _ in range(100):
            once()
        gc.collect()
        assert len(gc.get_objects()) - before < 60  # one for each would be 100


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="counts files as Linux lists them")
def test_contexts_that_come_and_go_leave_nothing(monkeypatch: pytest.MonkeyPatch, domain: int) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))

    def once() -> None:
        with Context() as context:
            furnished(context)

    for _ in range(3):
        once()
    gc.collect()
    files, threads = open_files(), threading.active_count()
    for _ in range(10):
        once()
    assert threading.active_count() == threads
    assert open_files() <= files + 2


def open_files() -> int:
    """Return how many files this process has open; zenoh keeps segments of shared memory as it likes."""
    found = 0
    for file in Path("/proc/self/fd").iterdir():
        with suppress(OSError):
            found += not str(file.readlink()).startswith("/dev/shm")
    return found


CLIENT = "from std_srvs.srv import Empty\nclient = node.create_client(Empty, 'nobody')"
PROGRAM = """
import rclpy
from rclpy.node import Node
rclpy.init()
node = Node("tested")
{middle}
print("ready", flush=True)
{end}
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("middle", "end"),
    [
        ("", "rclpy.spin(node)"),
        ("", "try:\n    rclpy.spin(node)\nfinally:\n    node.destroy_node()\n    rclpy.try_shutdown()"),
        ("", "try:\n    rclpy.spin(node)\nexcept KeyboardInterrupt:\n    pass\nnode.destroy_node()\nrclpy.shutdown()"),
        ("rate = node.create_rate(0.001)", "rate.sleep()"),
        (CLIENT, "client.wait_for_service()"),
        (
            CLIENT,
            "client.call(Empty.Request())",
        ),
        (
            "import threading\nfrom rclpy.executors import MultiThreadedExecutor\nexecutor = MultiThreadedExecutor()\n"
            "executor.add_node(node)\nthread = threading.Thread(target=executor.spin)\nthread.start()",
            "thread.join()",
        ),
    ],
    ids=["spin", "finally", "caught", "rate", "wait_for_service", "call", "thread"],
)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("middleware", ["rmw_zenoh_cpp", "rmw_cyclonedds_cpp"])
def test_a_program_that_is_asked_to_end_ends_without_a_traceback(
    middleware: str, middle: str, end: str, number: int, domain: int
) -> None:
    if "dds" in middleware:
        pytest.importorskip("cyclonedds", reason="the extra 'dds' is not installed")
    code = PROGRAM.format(middle=middle, end=end)
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "ROS_DOMAIN_ID": str(domain), "RMW_IMPLEMENTATION": middleware},
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(number)
        process.send_signal(number)  # a launcher and the terminal may both ask
        _, errors = process.communicate(timeout=20)
        assert errors == ""
    finally:
        process.kill()
        process.wait()
