"""Quality of service profiles."""

from __future__ import annotations

import warnings
from enum import Enum, IntEnum
from typing import Any, NamedTuple

from daidalos.transport.qos import (
    INFINITE_NS,
    Durability,
    History,
    Liveliness,
    Policy,
    Qos,
    Reliability,
    incompatibilities,
    incompatibility_text,
)
from rclpy.duration import Duration
from rclpy.impl.qos_policies import DurabilityPolicy as DurabilityPolicy
from rclpy.impl.qos_policies import HistoryPolicy as HistoryPolicy
from rclpy.impl.qos_policies import LivelinessPolicy as LivelinessPolicy
from rclpy.impl.qos_policies import QoSPolicyEnum as QoSPolicyEnum
from rclpy.impl.qos_policies import QoSPolicyKind as QoSPolicyKind
from rclpy.impl.qos_policies import ReliabilityPolicy as ReliabilityPolicy
from rclpy.impl.qos_policies import qos_policy_name_from_kind as qos_policy_name_from_kind


class InvalidQoSProfileException(Exception):
    """A profile lacks what it needs, or contradicts itself."""

    def __init__(self, *args: Any) -> None:
        super().__init__("Invalid QoSProfile", *args)


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy

_UNSPECIFIED = Duration()
_BEST_AVAILABLE_NS = 9223372036854775806
DeadlineBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)
LivelinessLeaseDurationeBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)
_KINDS: dict[str, type[Any]] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
    "lifespan": Duration,
    "deadline": Duration,
    "liveliness_lease_duration": Duration,
    "depth": int,
    "avoid_ros_namespace_conventions": bool,
}


class QoSProfile:
    """A quality of service profile; every policy is a keyword argument and an attribute.

    Raises
    ------
    InvalidQoSProfileException
        When neither `history` nor `depth` is given, or KEEP_LAST has no depth.
    AssertionError
        For an unknown policy, or a value of the wrong type.
    """

    __slots__ = (
        "_avoid_ros_namespace_conventions",
        "_deadline",
        "_depth",
        "_durability",
        "_history",
        "_lifespan",
        "_liveliness",
        "_liveliness_lease_duration",
        "_reliability",
    )  # fmt: skip

    def __init__(self, **kwargs: Any) -> None:
        unknown = kwargs.keys() - _KINDS.keys()
        assert not unknown, f"Invalid arguments passed to constructor: {unknown}"
        if "history" not in kwargs:
            if "depth" not in kwargs:
                raise InvalidQoSProfileException("History and/or depth settings are required.")
            kwargs["history"] = HistoryPolicy.KEEP_LAST
        if kwargs["history"] == HistoryPolicy.KEEP_LAST and "depth" not in kwargs:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        self.history = kwargs["history"]
        self.depth = kwargs.get("depth", 10)
        self.reliability = kwargs.get("reliability", ReliabilityPolicy.RELIABLE)
        self.durability = kwargs.get("durability", DurabilityPolicy.VOLATILE)
        self.lifespan = kwargs.get("lifespan", _UNSPECIFIED)
        self.deadline = kwargs.get("deadline", _UNSPECIFIED)
        self.liveliness = kwargs.get("liveliness", LivelinessPolicy.SYSTEM_DEFAULT)
        self.liveliness_lease_duration = kwargs.get("liveliness_lease_duration", _UNSPECIFIED)
        self.avoid_ros_namespace_conventions = kwargs.get("avoid_ros_namespace_conventions", False)

    @property
    def history(self) -> HistoryPolicy:
        """How many samples are kept."""
        return self._history

    @history.setter
    def history(self, value: HistoryPolicy | int) -> None:
        assert isinstance(value, (HistoryPolicy, int))
        self._history = HistoryPolicy(value)

    @property
    def reliability(self) -> ReliabilityPolicy:
        """Whether samples may be lost."""
        return self._reliability

    @reliability.setter
    def reliability(self, value: ReliabilityPolicy | int) -> None:
        assert isinstance(value, (ReliabilityPolicy, int))
        self._reliability = ReliabilityPolicy(value)

    @property
    def durability(self) -> DurabilityPolicy:
        """Whether late subscriptions get earlier samples."""
        return self._durability

    @durability.setter
    def durability(self, value: DurabilityPolicy | int) -> None:
        assert isinstance(value, (DurabilityPolicy, int))
        self._durability = DurabilityPolicy(value)

    @property
    def depth(self) -> int:
        """How many samples KEEP_LAST keeps."""
        return self._depth

    @depth.setter
    def depth(self, value: int) -> None:
        assert isinstance(value, int)
        if value < 0:
            raise ValueError("depth must be greater than or equal to zero")
        if self.history == HistoryPolicy.KEEP_LAST and value == 0:
            warnings.warn(
                "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. "
                "This will be interpreted as SYSTEM_DEFAULT",
                stacklevel=3,
            )
        self._depth = value

    @property
    def lifespan(self) -> Duration:
        """How long samples are valid."""
        return self._lifespan

    @lifespan.setter
    def lifespan(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._lifespan = value

    @property
    def deadline(self) -> Duration:
        """How long it takes at most from one sample to the next."""
        return self._deadline

    @deadline.setter
    def deadline(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._deadline = value

    @property
    def liveliness(self) -> LivelinessPolicy:
        """How a publisher shows that it is alive."""
        return self._liveliness

    @liveliness.setter
    def liveliness(self, value: LivelinessPolicy | int) -> None:
        assert isinstance(value, (LivelinessPolicy, int))
        self._liveliness = LivelinessPolicy(value)

    @property
    def liveliness_lease_duration(self) -> Duration:
        """How long a publisher that shows nothing counts as alive."""
        return self._liveliness_lease_duration

    @liveliness_lease_duration.setter
    def liveliness_lease_duration(self, value: Duration) -> None:
        assert isinstance(value, Duration)
        self._liveliness_lease_duration = value

    @property
    def avoid_ros_namespace_conventions(self) -> bool:
        """Whether the topic's name is used on the wire as it is."""
        return self._avoid_ros_namespace_conventions

    @avoid_ros_namespace_conventions.setter
    def avoid_ros_namespace_conventions(self, value: bool) -> None:
        assert isinstance(value, bool)
        self._avoid_ros_namespace_conventions = value

    def get_c_qos_profile(self) -> QoSProfile:
        """Return what the middleware takes: the object itself."""
        return self

    def to_dict(self) -> dict[str, Any]:
        """Return the policies, as keyword arguments of a profile."""
        return {slot[1:]: getattr(self, slot) for slot in self.__slots__}

    def resolved(self) -> Qos:
        """Return the profile with every "system default" replaced."""
        history = History.KEEP_ALL if self._history == HistoryPolicy.KEEP_ALL else History.KEEP_LAST
        best_effort = self._reliability == ReliabilityPolicy.BEST_EFFORT
        latched = self._durability == DurabilityPolicy.TRANSIENT_LOCAL
        manual = self._liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
        return Qos(
            Reliability.BEST_EFFORT if best_effort else Reliability.RELIABLE,
            Durability.TRANSIENT_LOCAL if latched else Durability.VOLATILE,
            history,
            self._depth,
            _resolved_ns(self._deadline),
            _resolved_ns(self._lifespan),
            Liveliness.MANUAL_BY_TOPIC if manual else Liveliness.AUTOMATIC,
            _resolved_ns(self._liveliness_lease_duration),
        )

    @classmethod
    def from_resolved(cls, qos: Qos) -> QoSProfile:
        """Return the profile of an endpoint in the graph."""
        return cls(
            history=HistoryPolicy(int(qos.history)),
            depth=qos.depth,
            reliability=ReliabilityPolicy(int(qos.reliability)),
            durability=DurabilityPolicy(int(qos.durability)),
            deadline=Duration(nanoseconds=qos.deadline_ns),
            lifespan=Duration(nanoseconds=qos.lifespan_ns),
            liveliness=LivelinessPolicy(int(qos.liveliness)),
            liveliness_lease_duration=Duration(nanoseconds=qos.liveliness_lease_ns),
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        values = ", ".join(f"{slot[1:]}={getattr(self, slot)!s}" for slot in self.__slots__)
        return f"{type(self).__name__}({values})"


def _resolved_ns(duration: Duration) -> int:
    ns = duration.nanoseconds
    return INFINITE_NS if ns in (0, _BEST_AVAILABLE_NS) else ns


def _profile(reliability: int, depth: int, durability: int = DurabilityPolicy.VOLATILE, **other: Any) -> QoSProfile:
    other.setdefault("history", HistoryPolicy.KEEP_LAST)
    return QoSProfile(reliability=reliability, durability=durability, depth=depth, **other)


qos_profile_unknown = _profile(
    ReliabilityPolicy.UNKNOWN,
    0,
    DurabilityPolicy.UNKNOWN,
    history=HistoryPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_default = _profile(ReliabilityPolicy.RELIABLE, 10)
qos_profile_system_default = _profile(
    ReliabilityPolicy.SYSTEM_DEFAULT,
    0,
    DurabilityPolicy.SYSTEM_DEFAULT,
    history=HistoryPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = _profile(ReliabilityPolicy.BEST_EFFORT, 5)
qos_profile_services_default = _profile(ReliabilityPolicy.RELIABLE, 10)
qos_profile_parameters = _profile(ReliabilityPolicy.RELIABLE, 1000)
qos_profile_parameter_events = _profile(ReliabilityPolicy.RELIABLE, 1000)
qos_profile_rosout_default = _profile(
    ReliabilityPolicy.RELIABLE, 1000, DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
qos_profile_best_available = _profile(
    ReliabilityPolicy.BEST_AVAILABLE,
    10,
    DurabilityPolicy.BEST_AVAILABLE,
    deadline=DeadlineBestAvailable,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=LivelinessLeaseDurationeBestAvailable,
)
qos_profile_action_status_default = _profile(ReliabilityPolicy.RELIABLE, 1, DurabilityPolicy.TRANSIENT_LOCAL)


class QoSPresetProfiles(Enum):
    """The profiles that ROS 2 comes with; a short key is a member's name in lower case."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the short keys."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return the profile with that short key."""
        return cls[name.upper()].value


class QoSCompatibility(IntEnum):
    """Compatibility of a publisher and a subscription."""

    OK = 0
    WARNING = 1
    ERROR = 2


class QoSCheckCompatibleResult(NamedTuple):
    """Result of `qos_check_compatible` with a reason, which is empty for compatible profiles."""

    compatibility: QoSCompatibility
    reason: str


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> QoSCheckCompatibleResult:
    """Return whether a publisher and a subscription with these profiles can talk.

    A profile with an unknown or system-default policy gives at best a warning: it may turn out either way.
    """
    found = incompatibilities(publisher_qos.resolved(), subscription_qos.resolved())
    unsure = _unsure(publisher_qos, subscription_qos)
    certain = [policy for policy in found if policy not in unsure]
    if certain:
        return QoSCheckCompatibleResult(QoSCompatibility.ERROR, incompatibility_text(certain))
    if unsure:
        reasons = "".join(
            f"WARNING: {policy.name.capitalize()} policy is not known on both sides;" for policy in unsure
        )
        return QoSCheckCompatibleResult(QoSCompatibility.WARNING, reasons)
    return QoSCheckCompatibleResult(QoSCompatibility.OK, "")


def _unsure(publisher: QoSProfile, subscription: QoSProfile) -> list[Policy]:
    checks = (
        (Policy.RELIABILITY, ReliabilityPolicy, "reliability"),
        (Policy.DURABILITY, DurabilityPolicy, "durability"),
    )
    return [
        policy
        for policy, kind, name in checks
        if {getattr(publisher, name), getattr(subscription, name)} & {kind.SYSTEM_DEFAULT, kind.UNKNOWN}
    ]
