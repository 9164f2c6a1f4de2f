"""Waiting for topics, pumping messages and changing them on their way."""

import threading

import pytest
import rclpy
from launch_testing_ros import DataRepublisher, MessagePump, WaitForTopics
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Int32, String

from ros.graph import spinning

LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish(node, topic, *words):
    publisher = node.create_publisher(String, topic, LATCHED)
    for word in words:
        publisher.publish(String(data=word))


def test_topics_on_which_something_comes(node):
    publish(node, "left", "a", "b", "c")
    publish(node, "right", "d")
    with WaitForTopics(
        [("left", String), ("right", String)], messages_received_buffer_length=2, qos_profile=LATCHED
    ) as waiting:
        assert waiting.topics_received() == {"left", "right"}
        assert waiting.topics_not_received() == set()
        assert [message.data for message in waiting.received_messages("right")] == ["d"]
        assert len(waiting.messages_received("left")) <= 2
        with pytest.raises(KeyError, match="'middle' is not one of the topics 'left', 'right'"):
            waiting.received_messages("middle")
    waiting.shutdown()


def test_a_silent_topic(node):
    publish(node, "loud", "a")
    topics = [("loud", String), ("silent", String)]
    waiting = WaitForTopics(topics, timeout=0.3, qos_profile=LATCHED)
    assert not waiting.wait()
    assert waiting.topics_received() == {"loud"}
    assert waiting.topics_not_received() == {"silent"}
    waiting.shutdown()
    with (
        pytest.raises(RuntimeError, match="Did not receive messages on these topics: 'silent'"),
        WaitForTopics(topics, timeout=0.1, qos_profile=LATCHED),
    ):
        pytest.fail("there was something on the silent topic")


def test_what_triggers_the_messages(graph):
    def trigger(node, word, times=1):
        publisher = node.create_publisher(String, "told", 10)
        for _ in range(times):
            publisher.publish(String(data=word))

    waiting = WaitForTopics([("told", String)], trigger=trigger, node_namespace="/robot")
    try:
        assert waiting.wait("hello", times=3)
        assert waiting.received_messages("told")[0].data == "hello"
    finally:
        waiting.shutdown()


def test_a_trigger_that_fails_leaves_nothing_behind(graph):
    threads = threading.active_count()

    def trigger(node):
        raise OSError("the door is shut")

    with pytest.raises(OSError, match="door"), WaitForTopics([("told", String)], trigger=trigger):
        pass
    assert threading.active_count() == threads
    with pytest.raises(TypeError, match="not callable"):
        WaitForTopics([], trigger=5)


def test_a_namespace_is_that_of_the_topics(node):
    publish(node, "/robot/left", "a")
    with WaitForTopics([("left", String)], node_namespace="robot", qos_profile=LATCHED) as waiting:
        assert waiting.topics_received() == {"left"}


def test_the_pump_runs_callbacks_until_it_is_stopped(node):
    came = threading.Event()
    node.create_subscription(Int32, "numbers", lambda message: came.set(), 10)
    other = rclpy.create_node("other")
    publisher = other.create_publisher(Int32, "numbers", 10)
    pump = MessagePump(node)
    pump.start()
    publisher.publish(Int32(data=1))
    assert came.wait(5.0)
    pump.stop()
    came.clear()
    publisher.publish(Int32(data=2))
    rclpy.spin_once(other, timeout_sec=0.1)
    assert not came.is_set()


def test_messages_are_changed_or_dropped_on_their_way(node):
    arrived = []
    done = threading.Event()
    tester = rclpy.create_node("tester")

    def listen(message):
        arrived.append(message.data)
        if message.data == 40:
            done.set()

    tester.create_subscription(Int32, "after", listen, 10)
    republisher = DataRepublisher(
        node, "before", "after", Int32, lambda message: Int32(data=10 * message.data) if message.data % 2 == 0 else None
    )
    publisher = tester.create_publisher(Int32, "before", 10)
    with spinning(node, tester):
        for number in range(1, 5):
            publisher.publish(Int32(data=number))
        assert done.wait(5.0)
    assert arrived == [20, 40]
    assert (republisher.get_num_received(), republisher.get_num_republished()) == (4, 2)
    assert [message.data for message in republisher.get_republished()] == [20, 40]
    republisher.shutdown()
    assert node.count_subscribers("before") == 0
