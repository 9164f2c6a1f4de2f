"""Filters at the end of a topic."""

import pytest
import rclpy
from geometry_msgs.msg import PointStamped
from message_filters import Cache, Subscriber, TimeSynchronizer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from ros.message_filters.messages import Output, real


def test_messages_of_a_topic(node: Node) -> None:
    subscriber = Subscriber(node, PointStamped, "points")
    output = Output(subscriber)
    publisher = node.create_publisher(PointStamped, "points", 10)
    publisher.publish(real(1, 5.0))
    rclpy.spin_once(node, timeout_sec=5.0)
    assert output.calls == [(real(1, 5.0),)]


def test_what_it_answers(node: Node) -> None:
    subscriber = Subscriber(node, PointStamped, "points")
    assert subscriber.getTopic() == subscriber.topic == "points"
    assert subscriber.topic_name == "/points"  # the subscription's
    assert subscriber.sub.msg_type is PointStamped
    with pytest.raises(AttributeError, match="nothing"):
        subscriber.nothing  # noqa: B018


@pytest.mark.parametrize(
    "qos", [3, QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)], ids=["depth", "profile"]
)
@pytest.mark.parametrize("by_name", [True, False])
def test_quality_of_service_and_other_options(node: Node, qos: object, by_name: bool) -> None:
    group = ReentrantCallbackGroup()
    if by_name:
        subscriber = Subscriber(node, PointStamped, "points", qos_profile=qos, callback_group=group)
    else:
        subscriber = Subscriber(node, PointStamped, "points", qos, callback_group=group)
    assert subscriber.qos_profile.depth == 3
    assert (subscriber.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT) is isinstance(qos, QoSProfile)
    assert subscriber.callback_group is group
    assert Subscriber(node, PointStamped, "points").qos_profile.depth == 10


def test_two_topics_together(node: Node) -> None:
    names = ("left", "right")
    together = TimeSynchronizer([Subscriber(node, PointStamped, name) for name in names], 10)
    output, cache = Output(together), Cache(Subscriber(node, PointStamped, "left"), 5)
    publishers = [node.create_publisher(PointStamped, name, 10) for name in names]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    publishers[0].publish(real(1, 1.0))
    publishers[0].publish(real(2, 2.0))
    publishers[1].publish(real(2, 3.0))
    for _ in range(5):
        executor.spin_once(timeout_sec=5.0)
    assert output.calls == [(real(2, 2.0), real(2, 3.0))]
    assert cache.getLast() == real(2, 2.0)
