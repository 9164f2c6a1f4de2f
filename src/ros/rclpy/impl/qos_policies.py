"""The policies of quality of service and their values, which are rmw's."""

from __future__ import annotations

from enum import IntEnum


class QoSPolicyKind(IntEnum):
    """The policies, with rmw's values."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256
    AVOID_ROS_NAMESPACE_CONVENTIONS = 512


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return a policy's name, such as ``DURABILITY``."""
    return QoSPolicyKind(policy_kind).name


class QoSPolicyEnum(IntEnum):
    """Base of the policies' enumerations; a short key is a member's name in lower case."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the short keys."""
        return [name.lower() for name in cls.__members__ if not name.startswith("RMW")]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        """Return the value of the member with that short key."""
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        """The member's name in lower case."""
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """History policy."""

    SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    KEEP_LAST = 1
    RMW_QOS_POLICY_HISTORY_KEEP_LAST = KEEP_LAST
    KEEP_ALL = 2
    RMW_QOS_POLICY_HISTORY_KEEP_ALL = KEEP_ALL
    UNKNOWN = 3
    RMW_QOS_POLICY_HISTORY_UNKNOWN = UNKNOWN


class ReliabilityPolicy(QoSPolicyEnum):
    """Reliability policy."""

    SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RELIABLE = 1
    RMW_QOS_POLICY_RELIABILITY_RELIABLE = RELIABLE
    BEST_EFFORT = 2
    RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT = BEST_EFFORT
    UNKNOWN = 3
    RMW_QOS_POLICY_RELIABILITY_UNKNOWN = UNKNOWN
    BEST_AVAILABLE = 4
    RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE = BEST_AVAILABLE


class DurabilityPolicy(QoSPolicyEnum):
    """Durability policy."""

    SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    TRANSIENT_LOCAL = 1
    RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL = TRANSIENT_LOCAL
    VOLATILE = 2
    RMW_QOS_POLICY_DURABILITY_VOLATILE = VOLATILE
    UNKNOWN = 3
    RMW_QOS_POLICY_DURABILITY_UNKNOWN = UNKNOWN
    BEST_AVAILABLE = 4
    RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE = BEST_AVAILABLE


class LivelinessPolicy(QoSPolicyEnum):
    """Liveliness policy."""

    SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    AUTOMATIC = 1
    RMW_QOS_POLICY_LIVELINESS_AUTOMATIC = AUTOMATIC
    MANUAL_BY_TOPIC = 3
    RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC = MANUAL_BY_TOPIC
    UNKNOWN = 4
    RMW_QOS_POLICY_LIVELINESS_UNKNOWN = UNKNOWN
    # rclpy misnames this alias; programs use it under that name.
    RMW_QOS_POLICY_DURABILITY_UNKNOWN = UNKNOWN
    BEST_AVAILABLE = 5
    RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE = BEST_AVAILABLE
