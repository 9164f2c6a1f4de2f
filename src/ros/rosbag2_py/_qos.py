"""Quality of service of topics in bags: rclcpp's class `QoS`, whose methods may be chained."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from rclpy.qos import QoSProfile

from daidalos.bags.qos import parse_profiles
from daidalos.transport.qos import Durability, History, Liveliness, Qos, Reliability

_SECOND = 1_000_000_000


class Duration:
    """A length of time, as rclcpp's class of this name is made."""

    def __init__(self, seconds: int, nanoseconds: int) -> None:
        self.nanoseconds = seconds * _SECOND + nanoseconds


class QoS:
    """Quality of service; every method changes it and returns it."""

    def __init__(self, history_depth: int) -> None:
        self.profile = Qos(depth=history_depth)

    @classmethod
    def of(cls, profile: Qos) -> QoS:
        """Return the object for a profile of the transport."""
        made = cls(profile.depth)
        made.profile = profile
        return made

    def _changed(self, **changes: Any) -> QoS:
        self.profile = replace(self.profile, **changes)
        return self

    def keep_last(self, depth: int) -> QoS:
        """Set the history to keep last, with this depth."""
        return self._changed(history=History.KEEP_LAST, depth=depth)

    def keep_all(self) -> QoS:
        """Set the history to keep all."""
        return self._changed(history=History.KEEP_ALL)

    def history(self, history: int) -> QoS:
        """Set the policy of history."""
        return self._changed(history=History(history))

    def reliable(self) -> QoS:
        """Set the reliability to reliable."""
        return self._changed(reliability=Reliability.RELIABLE)

    def best_effort(self) -> QoS:
        """Set the reliability to best effort."""
        return self._changed(reliability=Reliability.BEST_EFFORT)

    def reliability(self, reliability: int) -> QoS:
        """Set the policy of reliability."""
        return self._changed(reliability=Reliability(reliability))

    def transient_local(self) -> QoS:
        """Set the durability to transient local: late subscriptions get earlier samples."""
        return self._changed(durability=Durability.TRANSIENT_LOCAL)

    def durability_volatile(self) -> QoS:
        """Set the durability to volatile: late subscriptions get no earlier samples."""
        return self._changed(durability=Durability.VOLATILE)

    def durability(self, durability: int) -> QoS:
        """Set the policy of durability."""
        return self._changed(durability=Durability(durability))

    def liveliness(self, liveliness: int) -> QoS:
        """Set the policy of liveliness."""
        return self._changed(liveliness=Liveliness(liveliness))

    def deadline(self, deadline: Duration) -> QoS:
        """Set the deadline."""
        return self._changed(deadline_ns=deadline.nanoseconds)

    def lifespan(self, lifespan: Duration) -> QoS:
        """Set how long samples are valid."""
        return self._changed(lifespan_ns=lifespan.nanoseconds)

    def liveliness_lease_duration(self, liveliness_lease_duration: Duration) -> QoS:
        """Set the lease of liveliness."""
        return self._changed(liveliness_lease_ns=liveliness_lease_duration.nanoseconds)

    def avoid_ros_namespace_conventions(self, avoid: bool) -> QoS:
        """Accept the setting without effect: bags hold topics of ROS."""
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoS) and self.profile == other.profile

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"QoS({self.profile})"


def convert_rclcpp_qos_to_rclpy_qos(qos: QoS) -> QoSProfile:
    """Return the profile for rclpy."""
    return QoSProfile.from_resolved(qos.profile)


def to_rclcpp_qos_vector(profiles: str, version: int) -> list[QoS]:
    """Return the profiles that a text of a bag's metadata holds."""
    return [QoS.of(profile) for profile in parse_profiles(profiles)]


def resolved(profiles: str | Iterable[QoS | QoSProfile]) -> tuple[Qos, ...]:
    """Return what a program gave as offered profiles: a text (as ROS 2 Humble has it) or a list."""
    if isinstance(profiles, str):
        return parse_profiles(profiles)
    return tuple(one.profile if isinstance(one, QoS) else one.resolved() for one in profiles)


def common(offered: Sequence[Qos]) -> Qos | None:
    """Return the profile that all publishers offered; None when they differ in what matters to subscriptions."""
    first = offered[0]
    same = all(replace(one, history=first.history, depth=first.depth) == first for one in offered)
    return replace(first, depth=max(one.depth for one in offered)) if same else None
