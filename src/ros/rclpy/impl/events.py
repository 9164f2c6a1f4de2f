"""Events of publishers and subscriptions: matched, incompatible QoS, incompatible type."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any

from daidalos.transport.graph import EndpointInfo, EndpointKind
from daidalos.transport.qos import incompatibilities
from rclpy.impl.entities import EndpointHandle
from rclpy.impl.errors import UnsupportedEventTypeError
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


@dataclass(frozen=True)
class IncompatibleTypeStatus:
    """How many endpoints could not be matched because of their type."""

    total_count: int = 0
    total_count_change: int = 0


class EventSource:
    """Watches the graph for one kind of event of one endpoint; `on_ready` is called when its status changes."""

    def __init__(self, handle: EndpointHandle, on_ready: Callable[[], None], status: Any) -> None:
        self._mine = handle.endpoint
        self._lock = threading.Lock()
        self._status = status
        self._changed = False
        self._on_ready = on_ready
        self._stop = handle.node.session.watch(self._mine.name, self._on_change)

    def take(self) -> Any:
        """Return the status and begin to count changes anew; None when nothing changed."""
        with self._lock:
            if not self._changed:
                return None
            self._changed = False
            status = self._status
            zero = {name: 0 for name in status.__dataclass_fields__ if name.endswith("_change")}
            self._status = replace(status, **zero)
            return status

    def close(self) -> None:
        """Watch no more."""
        self._stop()

    def _on_change(self, added: bool, other: EndpointInfo) -> None:
        opposite = EndpointKind.SUBSCRIPTION if self._mine.kind is EndpointKind.PUBLISHER else EndpointKind.PUBLISHER
        if other.kind is not opposite:
            return
        with self._lock:
            status = self._next(added, other)
            if status is None:
                return
            self._status, self._changed = status, True
        self._on_ready()

    def _next(self, added: bool, other: EndpointInfo) -> Any:
        """Return the new status, None when the change is of no interest."""
        raise NotImplementedError

    def _same_type(self, other: EndpointInfo) -> bool:
        return other.type_name == self._mine.type_name

    def _faults(self, other: EndpointInfo) -> list[Any]:
        if self._mine.kind is EndpointKind.PUBLISHER:
            return list(incompatibilities(self._mine.qos, other.qos))
        return list(incompatibilities(other.qos, self._mine.qos))


class MatchedSource(EventSource):
    """Counts endpoints that match."""

    def _next(self, added: bool, other: EndpointInfo) -> Any:
        if not self._same_type(other) or self._faults(other):
            return None
        old, step = self._status, 1 if added else -1
        return MatchedStatus(
            old.total_count + added,
            old.total_count_change + added,
            old.current_count + step,
            old.current_count_change + step,
        )


class IncompatibleQosSource(EventSource):
    """Counts endpoints whose QoS forbids a match."""

    def _next(self, added: bool, other: EndpointInfo) -> Any:
        faults = self._faults(other) if added and self._same_type(other) else []
        if not faults:
            return None
        old = self._status
        return IncompatibleQosStatus(old.total_count + 1, old.total_count_change + 1, QoSPolicyKind(int(faults[-1])))


class IncompatibleTypeSource(EventSource):
    """Counts endpoints of another type."""

    def _next(self, added: bool, other: EndpointInfo) -> Any:
        if not added or self._same_type(other):
            return None
        old = self._status
        return IncompatibleTypeStatus(old.total_count + 1, old.total_count_change + 1)


_SOURCES: dict[IntEnum, tuple[type[EventSource], type[Any]]] = {
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED: (MatchedSource, MatchedStatus),
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: (
        IncompatibleQosSource,
        IncompatibleQosStatus,
    ),
    QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: (IncompatibleTypeSource, IncompatibleTypeStatus),
}
_SUBSCRIPTION_SOURCES: dict[IntEnum, tuple[type[EventSource], type[Any]]] = {
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: (MatchedSource, MatchedStatus),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: (
        IncompatibleQosSource,
        IncompatibleQosStatus,
    ),
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: (
        IncompatibleTypeSource,
        IncompatibleTypeStatus,
    ),
}


def event_source(handle: EndpointHandle, event_type: IntEnum, on_ready: Callable[[], None]) -> EventSource:
    """Return what watches for an event.

    Raises
    ------
    UnsupportedEventTypeError
        For an event that the middleware does not have.
    """
    table = _SOURCES if isinstance(event_type, QoSPublisherEventType) else _SUBSCRIPTION_SOURCES
    if event_type not in table:
        raise UnsupportedEventTypeError(f"the middleware has no event {event_type.name}")
    source, status = table[event_type]
    return source(handle, on_ready, status())
