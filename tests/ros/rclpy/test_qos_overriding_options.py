"""Quality of service that parameters override."""

from typing import Any

import pytest
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import InvalidQosOverridesError, QosCallbackResult, QoSOverridingOptions
from std_msgs.msg import String

DEFAULT = QoSOverridingOptions.with_default_policies()


def overrides(node: Node) -> dict[str, Any]:
    return {name: one.value for name, one in node.get_parameters_by_prefix("qos_overrides").items()}


def test_the_profile_is_declared_as_parameters(node: Node) -> None:
    profile = QoSProfile(depth=10)
    publisher = node.create_publisher(String, "/topic", profile, qos_overriding_options=DEFAULT)
    assert publisher.qos_profile == profile
    assert overrides(node) == {
        "/topic.publisher.depth": 10,
        "/topic.publisher.history": "keep_last",
        "/topic.publisher.reliability": "reliable",
    }
    result = node.set_parameters([Parameter("qos_overrides./topic.publisher.depth", value=3)])[0]
    assert not result.successful, "it is too late"


def test_parameters_outweigh_the_profile(graph: Context) -> None:
    policies = [kind for kind in QoSPolicyKind if kind is not QoSPolicyKind.INVALID]
    prefix = "qos_overrides./topic.subscription_mine."
    values = {
        "depth": 100,
        "history": "keep_all",
        "reliability": "best_effort",
        "durability": "transient_local",
        "deadline": 5_000_000,
        "liveliness": "manual_by_topic",
    }
    node = Node("tested", parameter_overrides=[Parameter(prefix + name, value=one) for name, one in values.items()])
    given = QoSProfile(depth=10)
    options = QoSOverridingOptions(policies, entity_id="mine")
    qos = node.create_subscription(String, "/topic", print, given, qos_overriding_options=options).qos_profile
    assert (qos.depth, qos.history) == (100, HistoryPolicy.KEEP_ALL)
    assert (qos.reliability, qos.durability) == (ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.TRANSIENT_LOCAL)
    assert qos.deadline == Duration(nanoseconds=5_000_000)
    assert given == QoSProfile(depth=10)
    assert f"{prefix.removeprefix('qos_overrides.')}lifespan" not in overrides(node), "subscriptions have none"
    node.destroy_node()


@pytest.mark.parametrize("refusal", [False, QosCallbackResult(successful=False, reason="too deep")])
def test_the_callback_may_refuse(node: Node, refusal: Any) -> None:
    seen: list[QoSProfile] = []

    def refuse(profile: QoSProfile) -> Any:
        seen.append(profile)
        return refusal

    options = QoSOverridingOptions.with_default_policies(callback=refuse)
    with pytest.raises(InvalidQosOverridesError):
        node.create_publisher(String, "topic", 10, qos_overriding_options=options)
    assert seen == [QoSProfile(depth=10)]
    assert node.count_publishers("topic") == 0


def test_a_value_that_is_none_of_the_policy_is_named(graph: Context) -> None:
    name = "qos_overrides./topic.publisher.reliability"
    node = Node("tested", parameter_overrides=[Parameter(name, value="perhaps")])
    with pytest.raises(InvalidQosOverridesError, match=f"{name}.*perhaps"):
        node.create_publisher(String, "topic", 10, qos_overriding_options=DEFAULT)
    node.destroy_node()


def test_a_second_publisher_of_the_topic_gets_the_same(node: Node) -> None:
    for _ in range(2):
        assert node.create_publisher(String, "topic", 10, qos_overriding_options=DEFAULT).qos_profile.depth == 10
