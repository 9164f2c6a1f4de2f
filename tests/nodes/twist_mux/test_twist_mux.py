"""Which velocity is passed on."""

from __future__ import annotations

from typing import Any

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import Bool

from daidalos.common.errors import UserError
from daidalos.nodes.twist_mux._priorities import Lock, Source, active, lock_priority
from daidalos.nodes.twist_mux.twist_mux import TwistMux

TOPICS = {
    "topics.navigation": ("nav_vel", 0.5, 10),
    "topics.joystick": ("joy_vel", 0.5, 100),
    "locks.pause": ("pause", 0.0, 11),
    "locks.watchdog": ("alive", 2.0, 255),
}


def parameters(settings: dict[str, tuple[Any, ...]]) -> list[Parameter]:
    fields = ("topic", "timeout", "priority")
    return [
        Parameter(f"{name}.{field}", value=value)
        for name, values in settings.items()
        for field, value in zip(fields, values, strict=False)
    ]


class Bench:
    """A multiplexer whose clock the test sets, with everything around it."""

    def __init__(self, node: Node, kind: type[Any] = Twist, **settings: Any) -> None:
        self.now = 100.0
        overrides = [*parameters(settings or TOPICS), Parameter("use_stamped", value=kind is TwistStamped)]
        self.mux = TwistMux(parameter_overrides=overrides)
        self.mux._now = lambda: self.now  # type: ignore[method-assign]
        self._node, self._kind = node, kind
        self.received: list[Any] = []
        node.create_subscription(kind, "cmd_vel_out", self.received.append, 10)

    def say(self, topic: str, message: Any) -> bool:
        """Publish, and tell whether it was passed on."""
        publisher = self._node.create_publisher(type(message), topic, 10)
        del self.received[:]
        publisher.publish(message)
        rclpy.spin_once(self.mux, timeout_sec=5.0)
        rclpy.spin_once(self._node, timeout_sec=0.05)
        return self.received == [message]

    def drive(self, topic: str) -> bool:
        message = self._kind()
        (message.twist if self._kind is TwistStamped else message).linear.x = 0.5
        return self.say(topic, message)

    def lock(self, topic: str, closed: bool) -> None:
        self.say(topic, Bool(data=closed))


@pytest.fixture
def bench(node: Node) -> Bench:
    bench = Bench(node)
    bench.lock("alive", False)
    return bench


def test_the_higher_priority_counts_until_it_is_silent(bench: Bench) -> None:
    assert bench.drive("nav_vel")
    assert bench.drive("joy_vel")
    bench.now += 0.4
    assert not bench.drive("nav_vel")
    bench.now += 0.2
    assert bench.drive("nav_vel")


def test_a_lock_stops_what_has_its_priority_or_less(bench: Bench) -> None:
    bench.lock("pause", True)
    assert not bench.drive("nav_vel")
    assert bench.drive("joy_vel")
    bench.now += 1.0
    assert not bench.drive("nav_vel")
    bench.lock("pause", False)
    assert bench.drive("nav_vel")


def test_a_lock_with_a_timeout_must_say_that_it_is_open(node: Node) -> None:
    bench = Bench(node)
    assert not bench.drive("joy_vel")
    bench.lock("alive", False)
    assert bench.drive("joy_vel")
    bench.now += 2.1
    assert not bench.drive("joy_vel")


def test_stamped_velocities(node: Node) -> None:
    bench = Bench(node, TwistStamped, **{"topics.a": ("a_vel", 0.5, 1)})
    assert bench.drive("a_vel")


def test_diagnostics(bench: Bench, node: Node) -> None:
    told: list[DiagnosticArray] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", told.append, 10)
    bench.drive("joy_vel")
    bench.lock("pause", True)
    bench.mux._diagnostics.force_update()
    rclpy.spin_once(node, timeout_sec=5.0)
    values = {pair.key: pair.value for pair in told[-1].status[0].values}
    assert values["velocity joystick"] == "unmasked (listening to joy_vel @ 0.5 s with priority #100)"
    assert values["velocity navigation"].startswith("silent")
    assert values["lock pause"].startswith("locked")
    assert (values["active velocity"], values["current priority"]) == ("joystick", "100")


@pytest.mark.usefixtures("graph")
@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({}, "needs sources"),
        ({"topics.a": ("a_vel", 0.5)}, r"'topics\.a\.priority' is missing"),
        ({"topics.a": ("a_vel", "soon", 5)}, r"'topics\.a\.timeout' of /twist_mux must be a float, got 'soon'"),
        ({"topics.a": ("a_vel", 0.5, 256)}, r"'topics\.a\.priority' of /twist_mux must be at most 255, got 256"),
        (
            {"topics.a": ("a_vel", 0.5, 5), "locks.b": ("b", -1.0, 5)},
            r"'locks\.b\.timeout' of /twist_mux must be at least 0, got -1",
        ),
    ],
)
def test_settings_that_make_no_sense(settings: dict[str, tuple[Any, ...]], reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        TwistMux(parameter_overrides=parameters(settings))


ages = st.none() | st.floats(0.0, 10.0)
sources = st.lists(st.tuples(st.integers(0, 4), st.sampled_from([0.0, 1.0, 5.0]), ages), max_size=5)
locks = st.lists(st.tuples(st.integers(0, 4), st.sampled_from([0.0, 1.0, 5.0]), ages, st.booleans()), max_size=3)


@given(sources, locks)
def test_the_choice_is_that_of_going_through_all_priorities(given_sources: Any, given_locks: Any) -> None:
    now = 50.0

    def received(age: float | None) -> float | None:
        return None if age is None else now - age

    made = [
        Source(str(place), "", timeout, priority, received(age))
        for place, (priority, timeout, age) in enumerate(given_sources)
    ]
    closed = [Lock("", "", timeout, priority, received(age), shut) for priority, timeout, age, shut in given_locks]
    chosen = None
    for priority in range(5):
        for source in reversed(made):
            fresh = source.received_at is not None and (
                source.timeout == 0 or now - source.received_at <= source.timeout
            )
            if source.priority == priority and fresh:
                chosen = source
        for lock in closed:
            quiet = lock.timeout > 0 and (lock.received_at is None or now - lock.received_at > lock.timeout)
            if lock.priority == priority and (quiet or lock.is_closed):
                chosen = None
    if chosen is not None and chosen.priority == 0:
        chosen = None  # as nothing is below it that could be locked
    assert active(made, closed, now) is chosen
    assert 0 <= lock_priority(closed, now) <= 4
