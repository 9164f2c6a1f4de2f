"""Quality of service: policies, and their compatibility between publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

INFINITE_NS = 2**63 - 1
"""Infinite duration, in nanoseconds."""
DEFAULT_DEPTH = 42
"""Depth that zenoh's ROS middleware takes where none is given."""


class Reliability(IntEnum):
    """Reliability policy, with the values of rmw."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class Durability(IntEnum):
    """Durability policy, with the values of rmw."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class History(IntEnum):
    """History policy, with the values of rmw."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class Liveliness(IntEnum):
    """Liveliness policy, with the values of rmw."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_NODE = 2
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


class Policy(IntEnum):
    """Names of the policies, with rmw's values (bits)."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256


@dataclass(frozen=True, slots=True)
class Qos:
    """Resolved profile without "system default" values; durations are in nanoseconds."""

    reliability: Reliability = Reliability.RELIABLE
    durability: Durability = Durability.VOLATILE
    history: History = History.KEEP_LAST
    depth: int = 10
    deadline_ns: int = INFINITE_NS
    lifespan_ns: int = INFINITE_NS
    liveliness: Liveliness = Liveliness.AUTOMATIC
    liveliness_lease_ns: int = INFINITE_NS

    @property
    def reliable(self) -> bool:
        """Whether no samples may be lost."""
        return self.reliability is Reliability.RELIABLE

    @property
    def transient_local(self) -> bool:
        """Whether late subscriptions receive earlier samples."""
        return self.durability is Durability.TRANSIENT_LOCAL

    @property
    def limit(self) -> int | None:
        """Maximum number of samples in a queue, None for unlimited."""
        return None if self.history is History.KEEP_ALL else max(self.depth, 1)


def incompatibilities(offered: Qos, requested: Qos) -> list[Policy]:
    """Return the policies by which a publisher cannot serve a subscription (DDS 1.4, 2.2.3)."""
    found = []
    if requested.reliable and not offered.reliable:
        found.append(Policy.RELIABILITY)
    if requested.transient_local and not offered.transient_local:
        found.append(Policy.DURABILITY)
    if offered.deadline_ns > requested.deadline_ns:
        found.append(Policy.DEADLINE)
    if (
        requested.liveliness is Liveliness.MANUAL_BY_TOPIC and offered.liveliness is Liveliness.AUTOMATIC
    ) or offered.liveliness_lease_ns > requested.liveliness_lease_ns:
        found.append(Policy.LIVELINESS)
    return found


_REASONS = {
    Policy.RELIABILITY: "Best effort publisher and reliable subscription",
    Policy.DURABILITY: "Volatile publisher and transient local subscription",
    Policy.DEADLINE: "Subscription's deadline is less than publisher's",
    Policy.LIVELINESS: "Publisher's liveliness does not meet the subscription's",
}


def incompatibility_text(policies: Iterable[Policy]) -> str:
    """Return what `incompatibilities` found as text in ROS 2's form: each reason between ``ERROR:`` and a semicolon."""
    return "".join(f"ERROR: {_REASONS[policy]};" for policy in policies)
