"""Events of publishers and subscriptions."""

from collections.abc import Callable
from typing import Any

import pytest
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.event_handler import (
    PublisherEventCallbacks,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSOfferedIncompatibleQoSInfo,
    QoSPublisherEventType,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
)
from rclpy.impl.errors import UnsupportedEventTypeError
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.impl.log_output import OUTPUT
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSPolicyKind, QoSProfile
from std_msgs.msg import Int32, String

from ros.rclpy.waiting import executor_of, run_ready, spin_until

SHORT = Duration(nanoseconds=20_000_000)
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
STRICT = QoSProfile(depth=10, deadline=SHORT)
MANUAL = QoSProfile(depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=SHORT)


class Both:
    """A publisher and a subscription of one topic, with what their events said."""

    def __init__(self, node: Node, offered: Any, requested: Any, *events: str) -> None:
        self.node, self.executor = node, executor_of(node)
        self.told: dict[str, list[Any]] = {}
        note = {name: self._noter(name) for name in events}
        of_publisher = {name[4:]: note[name] for name in events if name.startswith("pub_")}
        of_subscription = {name[4:]: note[name] for name in events if name.startswith("sub_")}
        self.subscription = node.create_subscription(
            String, "topic", lambda _: None, requested, event_callbacks=SubscriptionEventCallbacks(**of_subscription)
        )
        self.publisher = node.create_publisher(
            String, "topic", offered, event_callbacks=PublisherEventCallbacks(**of_publisher)
        )

    def _noter(self, name: str) -> Callable[[Any], None]:
        self.told[name] = []
        return self.told[name].append

    def wait_for(self, *names: str) -> list[Any]:
        spin_until(self.executor, lambda: all(self.told[name] for name in names))
        return [self.told[name][-1] for name in names]


def test_both_ends_are_told_of_their_match(node: Node) -> None:
    both = Both(node, 10, 10, "pub_matched", "sub_matched")
    for status in both.wait_for("pub_matched", "sub_matched"):
        assert (status.total_count, status.current_count) == (1, 1)
        assert (status.total_count_change, status.current_count_change) == (1, 1)
    both.told["pub_matched"].clear()
    node.destroy_subscription(both.subscription)
    (status,) = both.wait_for("pub_matched")
    assert (status.total_count, status.total_count_change) == (1, 0)
    assert (status.current_count, status.current_count_change) == (0, -1)


def test_both_ends_are_told_why_they_do_not_match(node: Node) -> None:
    both = Both(node, 10, LATCHED, "pub_incompatible_qos", "sub_incompatible_qos")
    for status in both.wait_for("pub_incompatible_qos", "sub_incompatible_qos"):
        assert (status.total_count, status.last_policy_kind) == (1, QoSPolicyKind.DURABILITY)


def test_who_asks_for_nothing_is_warned_of_what_does_not_match(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    logged: list[str] = []
    monkeypatch.setattr(OUTPUT, "write", lambda record: logged.append(record.message))
    both = Both(node, 10, LATCHED)
    spin_until(both.executor, lambda: len(logged) == 2)
    assert sorted(logged) == [
        "New publisher discovered on topic 'topic', offering incompatible QoS. No messages will be received from it. "
        "Last incompatible policy: DURABILITY",
        "New subscription discovered on topic 'topic', requesting incompatible QoS. No messages will be sent to it. "
        "Last incompatible policy: DURABILITY",
    ]


def test_other_types_are_told_of(node: Node) -> None:
    told: list[Any] = []
    node.create_publisher(Int32, "topic", 10, event_callbacks=PublisherEventCallbacks(incompatible_type=told.append))
    node.create_subscription(String, "topic", lambda _: None, 10)
    spin_until(executor_of(node), lambda: told)
    assert told[0].total_count == 1


def test_who_asks_for_nothing_is_warned_of_another_type(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    logged: list[str] = []
    monkeypatch.setattr(OUTPUT, "write", lambda record: logged.append(record.message))
    node.create_publisher(Int32, "topic", 10)
    node.create_subscription(String, "topic", lambda _: None, LATCHED)
    spin_until(executor_of(node), lambda: len(logged) == 2)
    assert sorted(logged) == [
        "Incompatible type on topic 'topic', no messages will be received from it.",
        "Incompatible type on topic 'topic', no messages will be sent to it.",
    ]


def test_two_types_that_a_bridge_joins_on_one_topic_are_no_fault(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    logged: list[str] = []
    monkeypatch.setattr(OUTPUT, "write", lambda record: logged.append(record.message))
    node.create_subscription(Int32, "topic", lambda _: None, 10)
    node.create_publisher(Int32, "topic", 10)
    node.create_publisher(String, "topic", 10)
    told: list[Any] = []
    callbacks = SubscriptionEventCallbacks(incompatible_type=told.append)
    node.create_subscription(String, "topic", lambda _: None, 10, event_callbacks=callbacks)
    spin_until(executor_of(node), lambda: told)
    run_ready(executor_of(node))
    assert logged == []


def test_deadlines_count_from_the_first_message(node: Node) -> None:
    both = Both(node, STRICT, STRICT, "pub_deadline", "sub_deadline")
    run_ready(both.executor)
    assert both.told == {"pub_deadline": [], "sub_deadline": []}
    both.publisher.publish(String())
    spin_until(both.executor, lambda: sum(one.total_count_change for one in both.told["pub_deadline"]) >= 3)
    (offered, requested) = both.wait_for("pub_deadline", "sub_deadline")
    assert offered.total_count >= 3
    assert requested.total_count >= 1
    assert offered.total_count == sum(one.total_count_change for one in both.told["pub_deadline"])


def test_a_manual_publisher_lives_as_long_as_it_says_so(node: Node) -> None:
    both = Both(node, MANUAL, MANUAL, "pub_liveliness", "sub_liveliness")
    (lost,) = both.wait_for("pub_liveliness")
    spin_until(both.executor, lambda: both.told["sub_liveliness"] and both.told["sub_liveliness"][-1].not_alive_count)
    assert lost.total_count == 1
    for show in (both.publisher.assert_liveliness, lambda: both.publisher.publish(String())):
        show()
        spin_until(both.executor, lambda: both.told["sub_liveliness"][-1].alive_count == 1)
        spin_until(both.executor, lambda: both.told["sub_liveliness"][-1].not_alive_count == 1)
    node.destroy_publisher(both.publisher)
    spin_until(both.executor, lambda: both.told["sub_liveliness"][-1].not_alive_count == 0)
    assert both.told["sub_liveliness"][-1].alive_count == 0


def test_an_automatic_publisher_lives_as_long_as_it_is_there(node: Node) -> None:
    both = Both(node, 10, 10, "sub_liveliness", "pub_liveliness")
    (changed,) = both.wait_for("sub_liveliness")
    assert (changed.alive_count, changed.not_alive_count) == (1, 0)
    both.told["sub_liveliness"].clear()
    node.destroy_publisher(both.publisher)
    (changed,) = both.wait_for("sub_liveliness")
    assert (changed.alive_count, changed.alive_count_change) == (0, -1)
    assert both.told["pub_liveliness"] == []


def test_gaps_in_the_sequence_are_lost_messages(node: Node) -> None:
    both = Both(node, 10, 10, "sub_message_lost")
    for _ in range(2):
        both.publisher.publish(String())
    run_ready(both.executor)
    assert both.told["sub_message_lost"] == []
    for _ in range(3):
        both.publisher.handle.impl._next_sequence()
    both.publisher.publish(String())
    (lost,) = both.wait_for("sub_message_lost")
    assert (lost.total_count, lost.total_count_change) == (3, 3)


def test_handlers_are_made_for_what_is_asked_and_the_warnings(node: Node) -> None:
    callbacks = PublisherEventCallbacks()
    counts = []
    for name in ("deadline", "liveliness", "matched", "incompatible_qos"):
        counts.append(len(node.create_publisher(String, "topic", 10, event_callbacks=callbacks).event_handlers))
        setattr(callbacks, name, print)
    assert len(node.create_publisher(String, "topic", 10, event_callbacks=callbacks).event_handlers) == 5
    assert counts == [2, 3, 4, 5]
    silent = SubscriptionEventCallbacks(use_default_callbacks=False)
    assert node.create_subscription(String, "topic", print, 10, event_callbacks=silent).event_handlers == []


P, S = QoSPublisherEventType, QoSSubscriptionEventType


@pytest.mark.parametrize(
    ("event", "status"),
    [
        (P.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, QoSOfferedDeadlineMissedInfo),
        (P.RCL_PUBLISHER_LIVELINESS_LOST, QoSLivelinessLostInfo),
        (P.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, QoSOfferedIncompatibleQoSInfo),
        (S.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, QoSRequestedDeadlineMissedInfo),
        (S.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, QoSLivelinessChangedInfo),
        (S.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, QoSRequestedIncompatibleQoSInfo),
        (S.RCL_SUBSCRIPTION_MESSAGE_LOST, QoSMessageLostInfo),
    ],
)
def test_events_can_be_waited_for_and_read_by_hand(graph: Context, node: Node, event: Any, status: type) -> None:
    entity = (
        node.create_publisher(String, "topic", 10)
        if isinstance(event, P)
        else node.create_subscription(String, "topic", print, 10)
    )
    with graph.handle:
        wait_set = _rclpy.WaitSet(0, 0, 0, 0, 0, 1, graph.handle)
    with entity.handle:
        handle = _rclpy.EventHandle(entity.handle, event)
    index = wait_set.add_event(handle)
    wait_set.wait(0)
    assert not wait_set.is_ready("event", index)
    with handle:
        taken = handle.take_event()
    assert isinstance(taken, status)
    assert all(not value for name, value in vars(taken).items() if name != "last_policy_kind")
    handle.destroy_when_not_in_use()


def test_what_is_no_event_is_refused(node: Node) -> None:
    publisher = node.create_publisher(String, "topic", 10)
    with pytest.raises(UnsupportedEventTypeError):
        _rclpy.EventHandle(publisher.handle, QoSPolicyKind.DEPTH)
