"""Names of rclpy's compiled module that programs use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import Any

from rclpy import qos
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.expand_topic_name import expand_topic_name as rclpy_expand_topic_name
from rclpy.impl.clock import ClockChange, ClockHandle
from rclpy.impl.context import ContextHandle
from rclpy.impl.entities import (
    ClientHandle,
    GuardConditionHandle,
    NodeHandle,
    PublisherHandle,
    ServiceHandle,
    SubscriptionHandle,
)
from rclpy.impl.errors import (
    InvalidHandle,
    NodeNameNonExistentError,
    RCLError,
    RCLInvalidROSArgsError,
    RCUtilsError,
    RMWError,
    TimerCancelledError,
    UnknownROSArgsError,
    UnsupportedEventTypeError,
)
from rclpy.impl.event_statuses import QoSPublisherEventType, QoSSubscriptionEventType
from rclpy.impl.events import EventSource, TopicHandle, event_source
from rclpy.impl.handle import Destroyable
from rclpy.impl.log_output import OUTPUT
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.node_graph import checked_name
from rclpy.impl.ready import ReadyNotifier
from rclpy.impl.timer import TimerHandle
from rclpy.impl.wait_set import WaitSet
from rclpy.qos import QoSCheckCompatibleResult, QoSCompatibility, QoSProfile, qos_check_compatible
from rclpy.serialization import deserialize_message as rclpy_deserialize
from rclpy.serialization import serialize_message as rclpy_serialize
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from rclpy.utilities import get_rmw_implementation_identifier as rclpy_get_rmw_implementation_identifier
from rclpy.utilities import remove_ros_args

__all__ = [
    "RCL_DEFAULT_DOMAIN_ID",
    "Client",
    "Clock",
    "ClockChange",
    "ClockType",
    "Context",
    "Destroyable",
    "EventHandle",
    "GuardCondition",
    "InvalidHandle",
    "Node",
    "NodeNameNonExistentError",
    "Publisher",
    "QoSCheckCompatibleResult",
    "QoSCompatibility",
    "QoSPublisherEventType",
    "QoSSubscriptionEventType",
    "RCLError",
    "RCLInvalidROSArgsError",
    "RCUtilsError",
    "RCutilsLogSeverity",
    "RMWError",
    "Service",
    "ServiceIntrospectionState",
    "SignalHandlerOptions",
    "Subscription",
    "Timer",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
    "WaitSet",
    "rclpy_deserialize",
    "rclpy_duration_t",
    "rclpy_expand_topic_name",
    "rclpy_get_rmw_implementation_identifier",
    "rclpy_logging_get_logger_effective_level",
    "rclpy_logging_set_logger_level",
    "rclpy_qos_check_compatible",
    "rclpy_remove_ros_args",
    "rclpy_serialize",
    "rclpy_time_point_t",
    "rmw_qos_profile_t",
]

RCL_DEFAULT_DOMAIN_ID = 2**64 - 1
"""A domain that means the one of the environment."""

Context = ContextHandle
Clock = ClockHandle
RCutilsLogSeverity = LoggingSeverity
rclpy_qos_check_compatible = qos_check_compatible
rclpy_remove_ros_args = remove_ros_args


def rclpy_duration_t(nanoseconds: int) -> Duration:
    """Return a duration."""
    return Duration(nanoseconds=nanoseconds)


def rclpy_time_point_t(nanoseconds: int, clock_type: ClockType) -> Time:
    """Return a point in time."""
    return Time(nanoseconds=nanoseconds, clock_type=clock_type)


def rclpy_logging_set_logger_level(name: str, level: int, detailed_error: bool = False) -> None:
    """Set the level of a logger."""
    OUTPUT.set_level(name, LoggingSeverity(level))


def rclpy_logging_get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level that applies to a logger."""
    return OUTPUT.effective_level(name)


def _nothing() -> None:
    """Ignore a notification: what is made here is waited for by wait sets."""


class rmw_qos_profile_t(QoSProfile):
    """A quality of service profile as the middleware takes it."""

    @staticmethod
    def predefined(name: str) -> QoSProfile:
        """Return a profile of `rclpy.qos` by its name there, such as ``qos_profile_default``."""
        profile: QoSProfile = getattr(qos, name)
        return profile


def Node(
    name: str,
    namespace: str,
    context: ContextHandle,
    arguments: Sequence[str] | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
) -> NodeHandle:
    """Return the handle of a new node."""
    return NodeHandle(context, name, namespace, list(arguments or ()), use_global_arguments)


class Publisher(PublisherHandle):
    """A publisher, by its node's handle."""

    def __init__(self, node: NodeHandle, message_type: Any, topic: str, qos: Any) -> None:
        super().__init__(node, message_type, checked_name(node, topic, is_service=False), qos)


class Subscription(SubscriptionHandle):
    """A subscription, by its node's handle."""

    def __init__(self, node: NodeHandle, message_type: Any, topic: str, qos: Any) -> None:
        super().__init__(node, message_type, checked_name(node, topic, is_service=False), qos)


class Service(ServiceHandle):
    """A service, by its node's handle."""

    def __init__(self, node: NodeHandle, service_type: Any, name: str, qos: Any) -> None:
        super().__init__(node, service_type, checked_name(node, name, is_service=True), qos)


class Client(ClientHandle):
    """A client, by its node's handle."""

    def __init__(self, node: NodeHandle, service_type: Any, name: str, qos: Any) -> None:
        super().__init__(node, service_type, checked_name(node, name, is_service=True), qos)


class Timer(TimerHandle):
    """A timer with a period in nanoseconds."""

    def __init__(self, clock: ClockHandle, context: ContextHandle, period_ns: int, autostart: bool = True) -> None:
        super().__init__(clock, period_ns, _nothing, autostart)


class GuardCondition(GuardConditionHandle):
    """A guard condition."""

    def __init__(self, context: ContextHandle) -> None:
        super().__init__(context, _nothing)


class EventHandle(Destroyable):
    """An event of a publisher or a subscription.

    Raises
    ------
    UnsupportedEventTypeError
        For what is no event.
    """

    def __init__(self, parent: TopicHandle, event_type: IntEnum) -> None:
        super().__init__()
        self._source: EventSource = event_source(parent, event_type, _nothing)

    @property
    def is_ready(self) -> bool:
        """Whether something happened since the last look."""
        return self._source.is_ready

    def listen(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a listener when something happens; the result ends that."""
        source: ReadyNotifier = self._source
        return source.listen(listener)

    def take_event(self) -> Any:
        """Return the status, whether or not it changed."""
        return self._source.read()

    def _destroy(self) -> None:
        self._source.close()
