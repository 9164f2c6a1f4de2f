"""The kinds of events of publishers and subscriptions, and what is told of them, as rcl and rmw name and number it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from rclpy.qos import QoSPolicyKind


class QoSPublisherEventType(IntEnum):
    """Events of publishers, with rcl's values."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """Events of subscriptions, with rcl's values."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


@dataclass(frozen=True)
class CountStatus:
    """How often something happened, and how often since the last look."""

    total_count: int = 0
    total_count_change: int = 0


class OfferedDeadlineMissedStatus(CountStatus):
    """How often a publisher was later than its deadline."""


class RequestedDeadlineMissedStatus(CountStatus):
    """How often nothing came to a subscription within its deadline."""


class LivelinessLostStatus(CountStatus):
    """How often a publisher failed to show that it was alive."""


class MessageLostStatus(CountStatus):
    """How many messages did not reach a subscription."""


class IncompatibleTypeStatus(CountStatus):
    """How many endpoints could not be matched because of their type."""


@dataclass(frozen=True)
class MatchedStatus:
    """How many endpoints of the other kind are and were matched, and the changes since the last look."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


@dataclass(frozen=True)
class IncompatibleQosStatus:
    """How many endpoints could not be matched because of their QoS, and the last policy that was at fault."""

    total_count: int = 0
    total_count_change: int = 0
    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


class OfferedIncompatibleQosStatus(IncompatibleQosStatus):
    """The same, of a publisher."""


class RequestedIncompatibleQosStatus(IncompatibleQosStatus):
    """The same, of a subscription."""


@dataclass(frozen=True)
class LivelinessChangedStatus:
    """How many of the matched publishers are alive and how many are not, and the changes since the last look."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0
