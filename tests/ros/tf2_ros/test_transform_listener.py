"""From a broadcaster to a buffer: through the graph, without an executor, and between two processes."""

import subprocess
import sys
import time
from collections.abc import Callable

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from tf2_msgs.msg import TFMessage
from tf2_ros import (
    Buffer,
    BufferCore,
    StaticTransformBroadcaster,
    StaticTransformListener,
    TransformBroadcaster,
    TransformListener,
)

from ros.graph import after, spinning
from ros.transforms import LATEST, SECOND, at, stamp, transform, translation

LONG = Duration(seconds=30)


@pytest.fixture
def buffer() -> Buffer:
    return Buffer()


# Receiving


def test_nobody_needs_to_spin(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node)
    sent = transform("a", "b", SECOND, (1.0, 2.0, 3.0))
    TransformBroadcaster(node).sendTransform(sent)
    assert buffer.lookup_transform("a", "b", LATEST, LONG) == sent


def test_several_transforms_in_one_message(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node)
    sent = [transform("a", "b", SECOND), transform("b", "c", SECOND)]
    broadcaster = TransformBroadcaster(node)
    broadcaster.sendTransform(sent)
    assert buffer.can_transform("a", "c", at(1), LONG)
    broadcaster.sendTransform(one for one in (transform("c", "d", SECOND), transform("d", "e", SECOND)))
    assert buffer.can_transform("a", "e", at(1), LONG)
    broadcaster.sendTransform((transform("e", "f", SECOND),))
    assert buffer.can_transform("a", "f", at(1), LONG)


def test_static_transforms_are_kept_for_who_comes_late(node: Node, buffer: Buffer) -> None:
    broadcaster = StaticTransformBroadcaster(node)
    message = transform("a", "b", xyz=(1.0, 0.0, 0.0))
    broadcaster.sendTransform(message)
    message.child_frame_id, message.transform.translation.x = "c", 2.0  # the same object, as programs do
    broadcaster.sendTransform(message)
    broadcaster.sendTransform([transform("b", "d", xyz=(4.0, 0.0, 0.0))])
    TransformListener(buffer, node)
    assert translation(buffer.lookup_transform("a", "b", at(7), LONG)) == [1.0, 0.0, 0.0]
    assert translation(buffer.lookup_transform("a", "c", at(7), LONG)) == [2.0, 0.0, 0.0]
    assert translation(buffer.lookup_transform("a", "d", at(7), LONG)) == [5.0, 0.0, 0.0]


def test_a_static_transform_may_be_corrected(node: Node, buffer: Buffer) -> None:
    broadcaster = StaticTransformBroadcaster(node)
    broadcaster.sendTransform(transform("a", "b", xyz=(1.0, 0.0, 0.0)))
    broadcaster.sendTransform(transform("a", "b", xyz=(2.0, 0.0, 0.0)))
    TransformListener(buffer, node)
    assert translation(buffer.lookup_transform("a", "b", LATEST, LONG)) == [2.0, 0.0, 0.0]


def test_a_static_listener_hears_nothing_else(node: Node, buffer: Buffer) -> None:
    listener = StaticTransformListener(buffer, node)
    TransformBroadcaster(node).sendTransform(transform("a", "b", SECOND))
    StaticTransformBroadcaster(node).sendTransform(transform("b", "c"))
    assert buffer.can_transform("b", "c", LATEST, LONG)
    assert not buffer.can_transform("a", "b", LATEST)
    assert not hasattr(listener, "tf_sub")


def test_other_topics(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node, tf_topic="robot/tf", tf_static_topic="robot/tf_static", qos=5, static_qos=7)
    node.create_publisher(TFMessage, "robot/tf", 5).publish(TFMessage(transforms=[transform("a", "b", SECOND)]))
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(TFMessage, "robot/tf_static", qos).publish(TFMessage(transforms=[transform("b", "c")]))
    TransformBroadcaster(node).sendTransform(transform("a", "z", SECOND))
    assert buffer.can_transform("a", "b", at(1), LONG)
    assert not buffer.can_transform("a", "z", LATEST)


def test_a_listener_without_a_node(graph: object, buffer: Buffer) -> None:
    listener = TransformListener(buffer, None)
    TransformBroadcaster(rclpy.create_node("sender")).sendTransform(transform("a", "b", SECOND))
    assert buffer.can_transform("a", "b", LATEST, LONG)
    assert listener.node.get_name().startswith("transform_listener_impl_")
    assert listener.node.get_parameter("use_sim_time").value is False


def test_nothing_is_heard_after_unregistering(node: Node, buffer: Buffer) -> None:
    listener = TransformListener(buffer, node)
    listener.unregister()
    listener.unregister()
    TransformBroadcaster(node).sendTransform(transform("a", "b", SECOND))
    assert not buffer.can_transform("a", "b", LATEST)
    assert listener.tf_sub not in list(node.subscriptions)


def test_the_graph_knows_the_subscriptions(node: Node, buffer: Buffer) -> None:
    listener = TransformListener(buffer, node)
    assert {one.topic_name for one in node.subscriptions} == {"/tf", "/tf_static"}
    assert node.count_subscribers("/tf") == node.count_subscribers("/tf_static") == 1
    assert listener.tf_sub.qos_profile.depth == 100
    assert listener.tf_static_sub.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL


def test_callbacks_may_be_called_by_hand(node: Node) -> None:
    buffer = BufferCore()  # any buffer will do
    listener = TransformListener(buffer, node)
    listener.callback(TFMessage(transforms=[transform("a", "b", SECOND)]))
    listener.static_callback(TFMessage(transforms=[transform("b", "c")]))
    assert buffer.can_transform_core("a", "c", LATEST) == (True, "")
    assert "broadcaster: 'default_authority'" in buffer.all_frames_as_yaml()


def test_a_subclass_may_replace_the_callback(node: Node, buffer: Buffer) -> None:
    class Counting(TransformListener):
        count = 0

        def callback(self, data: TFMessage) -> None:
            self.count += len(data.transforms)
            super().callback(data)

    listener = Counting(buffer, node)
    TransformBroadcaster(node).sendTransform([transform("a", "b", SECOND), transform("a", "c", SECOND)])
    assert buffer.can_transform("a", "c", LATEST, LONG)
    assert listener.count == 2


# Executors


@pytest.mark.parametrize("make", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_callback_may_wait_for_a_transform(
    node: Node, buffer: Buffer, make: Callable[[], SingleThreadedExecutor]
) -> None:
    TransformListener(buffer, node)
    broadcaster = TransformBroadcaster(node)
    found: list[object] = []
    sent = transform("a", "b", SECOND)

    def look_up() -> None:
        timer.cancel()
        after(0.05, lambda: broadcaster.sendTransform(sent))
        found.append(buffer.lookup_transform("a", "b", at(1), LONG))

    timer = node.create_timer(0.001, look_up)
    executor = make()
    executor.add_node(node)
    deadline = time.monotonic() + 20.0
    while not found and time.monotonic() < deadline:
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    assert found == [sent]


def test_who_steps_the_executor_is_told_of_every_message(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node)
    broadcaster, static = TransformBroadcaster(node), StaticTransformBroadcaster(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    for time_ns in range(1, 4):
        broadcaster.sendTransform(transform("a", "b", time_ns))
    static.sendTransform(transform("b", "c"))
    for _ in range(4):  # each would wait for ever if a message went unnoticed
        executor.spin_once()
    start = time.monotonic()
    executor.spin_once(timeout_sec=0.05)
    assert time.monotonic() - start >= 0.05
    after(0.05, lambda: broadcaster.sendTransform(transform("a", "b", 9)))
    executor.spin_once()
    assert buffer.can_transform("a", "b", Time(nanoseconds=9))


def test_an_executor_that_spins_is_left_to_sleep(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node)
    broadcaster = TransformBroadcaster(node)
    with spinning(node) as executor:
        executor.create_task(lambda: None)
        while not executor._spins or not executor._ready.empty():
            time.sleep(0.001)
        rounds = []
        wait, executor._wait = executor._wait, lambda *arguments: rounds.append(1) or wait(*arguments)
        for time_ns in range(1, 50):
            broadcaster.sendTransform(transform("a", "b", time_ns))
        assert buffer.can_transform("a", "b", Time(nanoseconds=49), LONG)
        assert len(rounds) <= 1


def test_a_thread_of_the_listener_s_spins_the_node(node: Node, buffer: Buffer) -> None:
    called: list[int] = []
    node.create_timer(0.001, lambda: called.append(1))
    listener = TransformListener(buffer, node, spin_thread=True)
    deadline = time.monotonic() + 10.0
    while not called and time.monotonic() < deadline:
        time.sleep(0.001)
    assert called
    listener.executor.shutdown()
    listener.dedicated_listener_thread.join(5.0)
    assert not listener.dedicated_listener_thread.is_alive()


def test_that_thread_ends_with_the_program(node: Node, buffer: Buffer) -> None:
    listener = TransformListener(buffer, node, spin_thread=True)
    rclpy.shutdown()
    listener.dedicated_listener_thread.join(5.0)
    assert not listener.dedicated_listener_thread.is_alive()


# Time


def test_a_buffer_made_without_a_node_follows_the_listener_s(node: Node, buffer: Buffer) -> None:
    TransformListener(buffer, node)
    assert buffer.clock is node.get_clock()
    buffer.set_transform(transform("a", "b", SECOND), "me")
    node.set_parameters([Parameter("use_sim_time", value=True)])
    assert not buffer.can_transform("a", "b", LATEST)
    TransformListener(buffer, rclpy.create_node("other"))
    assert buffer.clock is node.get_clock()


# Between processes

SENDER = """
import rclpy, sys
from geometry_msgs.msg import TransformStamped
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

rclpy.init()
node = rclpy.create_node("sender")
static, moving = StaticTransformBroadcaster(node), TransformBroadcaster(node)
fixed = TransformStamped(child_frame_id="laser")
fixed.header.frame_id = "base"
fixed.transform.translation.z = 0.5
static.sendTransform(fixed)
count = 0

def send():
    global count
    count += 1
    message = TransformStamped(child_frame_id="base")
    message.header.frame_id = "map"
    message.header.stamp.sec = count
    message.transform.translation.x = float(count)
    moving.sendTransform(message)

node.create_timer(0.02, send)
print("ready", flush=True)
try:
    rclpy.spin(node)
except BaseException:
    pass
"""


@pytest.mark.slow
def test_from_another_process(monkeypatch: pytest.MonkeyPatch, buffer: Buffer, domain: int) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    monkeypatch.delenv("RMW_IMPLEMENTATION", raising=False)
    sender = subprocess.Popen([sys.executable, "-c", SENDER], stdout=subprocess.PIPE, text=True)
    try:
        assert sender.stdout is not None
        assert sender.stdout.readline() == "ready\n"
        rclpy.init(args=[])
        node = rclpy.create_node("receiver")
        TransformListener(buffer, node)
        assert buffer.can_transform("map", "laser", LATEST, LONG)
        seen = buffer.lookup_transform("map", "laser", LATEST).header.stamp.sec
        found = buffer.lookup_transform("map", "laser", at(seen + 3.5), LONG)
        assert translation(found) == [seen + 3.5, 0.0, 0.5]
        assert found.header.stamp == stamp(seen * SECOND + 3_500_000_000)
    except ExternalShutdownException:
        pytest.fail("the context ended")
    finally:
        sender.kill()
        sender.wait()
        rclpy.try_shutdown()
