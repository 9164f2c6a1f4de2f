"""The kinds of events of publishers and subscriptions, and their statuses, as rcl and rmw name and number them."""

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
    """Number of events, and of those since the last call."""

    total_count: int = 0
    total_count_change: int = 0


class OfferedDeadlineMissedStatus(CountStatus):
    """Number of missed deadlines of a publisher."""


class RequestedDeadlineMissedStatus(CountStatus):
    """Number of missed deadlines of a subscription."""


class LivelinessLostStatus(CountStatus):
    """Number of times that a publisher lost its liveliness."""


class MessageLostStatus(CountStatus):
    """Number of messages that did not reach a subscription."""


class IncompatibleTypeStatus(CountStatus):
    """Number of endpoints that could not be matched because of their type."""


@dataclass(frozen=True)
class MatchedStatus:
    """Number of matched endpoints, current and total, with the changes since the last call."""

    total_count: int = 0
    total_count_change: int = 0
    current_count: int = 0
    current_count_change: int = 0


@dataclass(frozen=True)
class IncompatibleQosStatus:
    """Number of endpoints that could not be matched because of their QoS, and the last incompatible policy."""

    total_count: int = 0
    total_count_change: int = 0
    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


class OfferedIncompatibleQosStatus(IncompatibleQosStatus):
    """The same, of a publisher."""


class RequestedIncompatibleQosStatus(IncompatibleQosStatus):
    """The same, of a subscription."""


@dataclass(frozen=True)
class LivelinessChangedStatus:
    """Number of alive and not alive matched publishers, with the changes since the last call."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0
