"""The policy BEST_AVAILABLE: what matches as many endpoints as possible, as rmw defines it."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING

from daidalos.transport.graph import EndpointKind, Graph
from daidalos.transport.qos import Liveliness, Qos
from rclpy.duration import Duration
from rclpy.qos import (
    DeadlineBestAvailable,
    DurabilityPolicy,
    LivelinessLeaseDurationeBestAvailable,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Callable


def best_available_offer(profile: QoSProfile, graph: Graph, topic: str) -> QoSProfile:
    """Return a publisher's profile that serves every subscription of the topic as far as it can."""
    if not _leaves_open(profile):
        return profile
    known = [one.qos for one in graph.endpoints(EndpointKind.SUBSCRIPTION, name=topic)]
    manual = any(qos.liveliness is Liveliness.MANUAL_BY_TOPIC for qos in known)
    return _chosen(profile, known, True, True, manual, min)


def best_available_request(profile: QoSProfile, graph: Graph, topic: str) -> QoSProfile:
    """Return a subscription's profile that asks for no more than every publisher of the topic gives."""
    if not _leaves_open(profile):
        return profile
    known = [one.qos for one in graph.endpoints(EndpointKind.PUBLISHER, name=topic)]
    reliable = all(qos.reliable for qos in known)
    latched = all(qos.transient_local for qos in known)
    manual = bool(known) and all(qos.liveliness is Liveliness.MANUAL_BY_TOPIC for qos in known)
    return _chosen(profile, known, reliable, latched, manual, max)


def _leaves_open(profile: QoSProfile) -> bool:
    return (
        profile.reliability == ReliabilityPolicy.BEST_AVAILABLE
        or profile.durability == DurabilityPolicy.BEST_AVAILABLE
        or profile.liveliness == LivelinessPolicy.BEST_AVAILABLE
        or profile.deadline == DeadlineBestAvailable
        or profile.liveliness_lease_duration == LivelinessLeaseDurationeBestAvailable
    )


def _chosen(
    profile: QoSProfile,
    known: list[Qos],
    reliable: bool,
    latched: bool,
    manual: bool,
    choose: Callable[..., int],
) -> QoSProfile:
    """Return the profile with what it leaves open filled in; `choose` picks among durations."""
    result = copy.copy(profile)
    if result.reliability == ReliabilityPolicy.BEST_AVAILABLE:
        result.reliability = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    if result.durability == DurabilityPolicy.BEST_AVAILABLE:
        result.durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    if result.liveliness == LivelinessPolicy.BEST_AVAILABLE:
        result.liveliness = LivelinessPolicy.MANUAL_BY_TOPIC if manual else LivelinessPolicy.AUTOMATIC
    if result.deadline == DeadlineBestAvailable and known:
        result.deadline = Duration(nanoseconds=choose(qos.deadline_ns for qos in known))
    if result.liveliness_lease_duration == LivelinessLeaseDurationeBestAvailable and known:
        result.liveliness_lease_duration = Duration(nanoseconds=choose(qos.liveliness_lease_ns for qos in known))
    return result
