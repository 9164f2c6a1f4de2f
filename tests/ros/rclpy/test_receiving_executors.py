"""Executors that receive from DDS themselves, without a change of threads for each message."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32

from daidalos.transport.environment import Environment
from daidalos.transport.graph import NodeInfo
from daidalos.transport.publisher import Publisher
from daidalos.transport.qos import Qos
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from ros.rclpy.waiting import LONG, executor_of, spin_until

pytest.importorskip("cyclonedds")

_DDS = "rmw_cyclonedds_cpp"


@pytest.fixture
def node(domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """A node that reaches others over DDS; signals are watched, as in every program."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", _DDS)
    with rclpy.init(args=[], domain_id=domain):
        yield rclpy.create_node("here")


class _Peer:
    """A node as in another process."""

    def __init__(self, domain: int) -> None:
        self._session = Session(make_backend(Environment(domain, middleware=_DDS)))
        self._node: NodeInfo = self._session.create_node("there", "/")[0]

    def publisher(self, topic: str, depth: int = 10) -> Publisher:
        """Return a publisher that has found its subscription."""
        made = self._session.create_publisher(self._node, topic, Int32, Qos(depth=depth))
        assert self._session.graph.wait_for(lambda: made.has_subscribers, LONG)
        return made

    def close(self) -> None:
        self._session.close()


@pytest.fixture
def peer(domain: int) -> Iterator[_Peer]:
    made = _Peer(domain)
    yield made
    made.close()


def test_the_executor_receives_what_its_callbacks_get(node: Node, peer: _Peer) -> None:
    receivers: list[str] = []
    received, ended = threading.Semaphore(0), threading.Event()
    subscription = node.create_subscription(Int32, "topic", lambda _: received.release(), 10)
    subscription.handle.impl.observe(lambda _: receivers.append(threading.current_thread().name))
    executor, publisher = executor_of(node), peer.publisher("/topic")

    def answer() -> None:
        while not ended.is_set():
            publisher.publish(Int32())
            received.acquire(timeout=LONG)

    answering = threading.Thread(target=answer)
    answering.start()
    spin_until(executor, lambda: threading.current_thread().name in receivers)
    ended.set()
    answering.join(LONG)


def test_others_receive_while_a_callback_takes_long(node: Node, peer: _Peer) -> None:
    begun, done, received = threading.Event(), threading.Event(), threading.Event()

    def wait(_: Int32) -> None:
        begun.set()
        assert done.wait(LONG)

    node.create_subscription(Int32, "long", wait, 10)
    other = rclpy.create_node("other")
    other.create_subscription(Int32, "short", lambda _: received.set(), 10)
    executor = SingleThreadedExecutor()
    executor.add_node(other)
    spinning = threading.Thread(target=executor.spin)
    spinning.start()
    long, short = peer.publisher("/long"), peer.publisher("/short")

    def disturb() -> None:
        begun.wait(LONG)
        short.publish(Int32(data=1))
        received.wait(LONG)
        done.set()

    disturbing = threading.Thread(target=disturb)
    disturbing.start()
    for number in range(2):  # the second is received by an executor that has received before
        long.publish(Int32(data=number))
    mine = executor_of(node)
    spin_until(mine, done.is_set)
    assert received.is_set()
    executor.shutdown()
    for thread in (spinning, disturbing):
        thread.join(LONG)
        assert not thread.is_alive()


def test_nothing_is_lost_where_the_queue_is_short(node: Node, peer: _Peer) -> None:
    received: list[int] = []
    node.create_subscription(Int32, "topic", lambda message: received.append(message.data), 2)
    executor, publisher, count = executor_of(node), peer.publisher("/topic", 2), 3000

    def flood() -> None:
        for number in range(count):
            publisher.publish(Int32(data=number))

    flooding = threading.Thread(target=flood)
    flooding.start()
    spin_until(executor, lambda: len(received) == count)
    flooding.join(LONG)
    assert received == list(range(count))


def test_an_executor_that_waits_is_woken_by_other_threads(node: Node) -> None:
    executor, done = executor_of(node), []

    def create_task() -> None:
        executor.create_task(lambda: done.append(1))

    for count in range(20):
        waking = threading.Thread(target=create_task)
        waking.start()
        spin_until(executor, lambda count=count: len(done) > count)
        waking.join(LONG)
    closing = threading.Thread(target=executor.shutdown)
    closing.start()
    executor.spin()
    closing.join(LONG)


def test_a_closed_context_ends_the_wait(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", _DDS)
    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    executor = executor_of(rclpy.create_node("here", context=context))
    ended = threading.Event()

    def spin() -> None:
        with pytest.raises(rclpy.executors.ExternalShutdownException):
            executor.spin()
        ended.set()

    spinning = threading.Thread(target=spin)
    spinning.start()
    rclpy.shutdown(context=context)
    assert ended.wait(LONG)
    spinning.join(LONG)


_PROGRAM = """
import rclpy
rclpy.init()
node = rclpy.create_node("interrupted")
def tick():
    if {once}:
        timer.cancel()
    print("ready", flush=True)
timer = node.create_timer(0.001, tick)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals are not sent to threads here")
@pytest.mark.parametrize("once", [True, False])
def test_ctrl_c_ends_the_wait(domain: int, once: bool) -> None:
    environment = os.environ | {"RMW_IMPLEMENTATION": _DDS, "ROS_DOMAIN_ID": str(domain)}
    program = [sys.executable, "-c", _PROGRAM.format(once=once)]
    with subprocess.Popen(program, stdout=subprocess.PIPE, env=environment) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"ready\n"
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=LONG)[0].endswith(b"interrupted\n")
        assert process.returncode == 0
