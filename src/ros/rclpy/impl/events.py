"""Events of publishers and subscriptions, by what the graph and the samples show: no middleware is asked for them.

When an event is counted is DDS 1.4, 2.2.4: a deadline is missed each time that long passes without a sample; a manual
publisher is alive as long as it publishes or asserts its liveliness within its lease.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from enum import IntEnum
from typing import Any

from daidalos.transport.backend import SampleInfo
from daidalos.transport.graph import EndpointInfo, EndpointKind
from daidalos.transport.qos import INFINITE_NS, Liveliness, Qos, incompatibilities
from daidalos.transport.steady_timers import STEADY_TIMERS, SteadyTimer
from daidalos.transport.subscription import Subscription
from rclpy.impl.entities import PublisherHandle, SubscriptionHandle, liveliness_topic
from rclpy.impl.errors import UnsupportedEventTypeError
from rclpy.impl.event_statuses import (
    IncompatibleTypeStatus,
    LivelinessChangedStatus,
    LivelinessLostStatus,
    MatchedStatus,
    MessageLostStatus,
    OfferedDeadlineMissedStatus,
    OfferedIncompatibleQosStatus,
    QoSPublisherEventType,
    QoSSubscriptionEventType,
    RequestedDeadlineMissedStatus,
    RequestedIncompatibleQosStatus,
)
from rclpy.impl.ready import ReadyNotifier, weakly
from rclpy.qos import QoSPolicyKind

TopicHandle = PublisherHandle | SubscriptionHandle


class EventSource(ReadyNotifier):
    """Base: holds the status of one event of one endpoint; `on_ready` is called when it changes."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        self._handle = handle
        self._mine = handle.endpoint
        self._lock = threading.RLock()
        self._status = status
        self.is_ready = False
        self.announce_to(on_ready)

    def _wire(self, call: Callable[[], None]) -> None:
        self._on_ready = call

    def take(self) -> Any:
        """Return the status and begin to count changes anew; None when nothing changed."""
        with self._lock:
            return self.read() if self.is_ready else None

    def read(self) -> Any:
        """Return the status, changed or not, and begin to count changes anew."""
        with self._lock:
            self.is_ready = False
            status = self._status
            zero = {name: 0 for name in status.__dataclass_fields__ if name.endswith("_change")}
            self._status = replace(status, **zero)
            return status

    def close(self) -> None:
        """Stop watching."""

    def _change(self, **steps: int) -> None:
        """Add to counts of the status, and to their changes; a field without one is set."""
        with self._lock:
            fields: dict[str, Any] = {}
            for name, step in steps.items():
                changes = f"{name}_change"
                if hasattr(self._status, changes):
                    fields[name] = getattr(self._status, name) + step
                    fields[changes] = getattr(self._status, changes) + step
                else:
                    fields[name] = step
            self._status = replace(self._status, **fields)
            self.is_ready = True
        self._on_ready()


class GraphSource(EventSource):
    """An event that comes from endpoints which come and go."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        super().__init__(handle, on_ready, status)
        publishes = self._mine.kind is EndpointKind.PUBLISHER
        opposite = EndpointKind.SUBSCRIPTION if publishes else EndpointKind.PUBLISHER
        self._stop = handle.node.session.watch(self._mine.name, weakly(self._note), opposite)

    def close(self) -> None:
        """Stop watching."""
        self._stop()

    def _note(self, added: bool, other: EndpointInfo) -> None:
        """Count an endpoint of the other kind that came or went."""
        raise NotImplementedError

    def _same_type(self, other: EndpointInfo) -> bool:
        return other.type_name == self._mine.type_name

    def _faults(self, other: EndpointInfo) -> list[Any]:
        if self._mine.kind is EndpointKind.PUBLISHER:
            return list(incompatibilities(self._mine.qos, other.qos))
        return list(incompatibilities(other.qos, self._mine.qos))

    def _matches(self, other: EndpointInfo) -> bool:
        return self._same_type(other) and not self._faults(other)


class MatchedSource(GraphSource):
    """Source that counts endpoints that match."""

    def _note(self, added: bool, other: EndpointInfo) -> None:
        if self._matches(other):
            self._change(total_count=int(added), current_count=1 if added else -1)


class IncompatibleQosSource(GraphSource):
    """Source that counts endpoints whose QoS forbids a match."""

    def _note(self, added: bool, other: EndpointInfo) -> None:
        faults = self._faults(other) if added and self._same_type(other) else []
        if faults:
            self._change(total_count=1, last_policy_kind=QoSPolicyKind(int(faults[0])))


class IncompatibleTypeSource(GraphSource):
    """Source that counts endpoints of another type."""

    def _note(self, added: bool, other: EndpointInfo) -> None:
        if added and not self._same_type(other):
            self._change(total_count=1)


class LivelinessChangedSource(GraphSource):
    """Source that counts publishers that are alive: those in the graph, and manual ones as long as they assert it."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        self._leases: dict[bytes, _Lease] = {}
        self._assertions: Subscription | None = None
        super().__init__(handle, on_ready, status)
        handle.impl.observe(weakly(self._on_sample))

    def _note(self, added: bool, other: EndpointInfo) -> None:
        if not self._matches(other):
            return
        if added:
            if other.qos.liveliness is Liveliness.MANUAL_BY_TOPIC and other.qos.liveliness_lease_ns < INFINITE_NS:
                self._leases[other.gid] = _Lease(other.qos.liveliness_lease_ns, self._on_lapse)
                if self._assertions is None:
                    self._assertions = self._subscribe_to_liveliness()
            self._change(alive_count=1)
            return
        lease = self._leases.pop(other.gid, None)
        if lease is None or lease.end():
            self._change(alive_count=-1)
        else:
            self._change(not_alive_count=-1)

    def _subscribe_to_liveliness(self) -> Subscription:
        from rmw_dds_common.msg import Gid

        node = self._handle.node
        on_ready = weakly(self._read_assertions)
        return node.session.create_subscription(node.info, liveliness_topic(self._mine.name), Gid, Qos(), on_ready)

    def _read_assertions(self) -> None:
        assertions = self._assertions
        taken = assertions.take() if assertions is not None else None
        while assertions is not None and taken is not None:
            self._on_assertion(bytes(taken[0].data))
            taken = assertions.take()

    def _on_lapse(self) -> None:
        self._change(alive_count=-1, not_alive_count=1)

    def _on_sample(self, info: SampleInfo) -> None:
        self._on_assertion(info.gid)

    def _on_assertion(self, gid: bytes) -> None:
        lease = self._leases.get(gid)
        if lease is not None and not lease.renew():
            self._change(alive_count=1, not_alive_count=-1)

    def close(self) -> None:
        """Stop watching."""
        super().close()
        if self._assertions is not None:
            self._assertions.close()
        for lease in self._leases.values():
            lease.end()


class _Lease:
    """A time within which something must happen again; `on_lapse` is called when it did not."""

    def __init__(self, span_ns: int, on_lapse: Any) -> None:
        self._span = span_ns
        self._on_lapse = weakly(on_lapse)
        self._lock = threading.Lock()
        self._valid = False
        self._timer: SteadyTimer | None = None
        self._until = 0
        self.renew()

    def renew(self) -> bool:
        """Restart the span; return whether it had not ended."""
        with self._lock:
            was, self._valid = self._valid, True
            self._until = time.monotonic_ns() + self._span
            if not was:
                self._timer = STEADY_TIMERS.at(self._until, self._check)
        return was

    def _check(self) -> None:
        with self._lock:
            if not self._valid:
                return
            if self._until > time.monotonic_ns():  # renewed meanwhile
                self._timer = STEADY_TIMERS.at(self._until, self._check)
                return
            self._valid = False
        self._on_lapse()

    def end(self) -> bool:
        """Stop watching; return whether it had not ended."""
        with self._lock:
            was, self._valid = self._valid, False
            timer, self._timer = self._timer, None
        if timer:
            timer.cancel()
        return was


class LivelinessLostSource(EventSource):
    """Source that counts how often a manual publisher did not show that it was alive."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        super().__init__(handle, on_ready, status)
        qos = self._mine.qos
        self._lease: _Lease | None = None
        if qos.liveliness is Liveliness.MANUAL_BY_TOPIC and qos.liveliness_lease_ns < INFINITE_NS:
            self._lease = _Lease(qos.liveliness_lease_ns, self._on_lapse)
            handle.impl.observe(weakly(self._lease.renew))

    def _on_lapse(self) -> None:
        self._change(total_count=1)

    def close(self) -> None:
        """Stop watching."""
        if self._lease:
            self._lease.end()


class DeadlineSource(EventSource):
    """Source that counts how often a deadline passed without a sample, from the first sample on."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        super().__init__(handle, on_ready, status)
        self._span = self._mine.qos.deadline_ns
        self._last = self._start = 0
        self._timer: SteadyTimer | None = None
        self._closed = False
        if self._span < INFINITE_NS:
            handle.impl.observe(weakly(self._on_sample))

    def _on_sample(self, info: SampleInfo | None = None) -> None:
        first, self._last = not self._last, time.monotonic_ns()
        if first:
            self._plan()

    def _plan(self) -> None:
        """Schedule the check of the deadline that the last sample began."""
        with self._lock:
            if not self._closed:
                self._start = self._last
                self._timer = STEADY_TIMERS.at(self._start + self._span, weakly(self._check))

    def _check(self) -> None:
        if self._last == self._start:
            if self._has_counterparts():
                self._change(total_count=1)
            self._last += self._span
        self._plan()

    def _has_counterparts(self) -> bool:
        """Return whether somebody could have sent: a subscription without publishers misses nothing."""
        return self._mine.kind is EndpointKind.PUBLISHER or bool(
            self._handle.node.session.matching_endpoints(self._mine)
        )

    def close(self) -> None:
        """Stop watching."""
        with self._lock:
            self._closed = True
            timer, self._timer = self._timer, None
        if timer:
            timer.cancel()


class MessageLostSource(EventSource):
    """Source that counts the gaps in publishers' sequence numbers."""

    def __init__(self, handle: TopicHandle, on_ready: Callable[[], None], status: Any) -> None:
        super().__init__(handle, on_ready, status)
        self._last: dict[bytes, int] = {}
        handle.impl.observe(weakly(self._on_sample))

    def _on_sample(self, info: SampleInfo) -> None:
        last, self._last[info.gid] = self._last.get(info.gid, info.sequence - 1), info.sequence
        lost = info.sequence - last - 1
        if lost > 0:
            self._change(total_count=lost)


_P, _S = QoSPublisherEventType, QoSSubscriptionEventType
_SOURCES: dict[tuple[type[IntEnum], int], tuple[type[EventSource], type[Any]]] = {
    (type(kind), int(kind)): (source, status)
    for kind, source, status in (
        (_P.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, DeadlineSource, OfferedDeadlineMissedStatus),
        (_P.RCL_PUBLISHER_LIVELINESS_LOST, LivelinessLostSource, LivelinessLostStatus),
        (_P.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, IncompatibleQosSource, OfferedIncompatibleQosStatus),
        (_P.RCL_PUBLISHER_INCOMPATIBLE_TYPE, IncompatibleTypeSource, IncompatibleTypeStatus),
        (_P.RCL_PUBLISHER_MATCHED, MatchedSource, MatchedStatus),
        (_S.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, DeadlineSource, RequestedDeadlineMissedStatus),
        (_S.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, LivelinessChangedSource, LivelinessChangedStatus),
        (_S.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, IncompatibleQosSource, RequestedIncompatibleQosStatus),
        (_S.RCL_SUBSCRIPTION_MESSAGE_LOST, MessageLostSource, MessageLostStatus),
        (_S.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE, IncompatibleTypeSource, IncompatibleTypeStatus),
        (_S.RCL_SUBSCRIPTION_MATCHED, MatchedSource, MatchedStatus),
    )
}


def event_source(handle: TopicHandle, event_type: IntEnum, on_ready: Callable[[], None]) -> EventSource:
    """Return the source of an event.

    Raises
    ------
    UnsupportedEventTypeError
        For what is no event.
    """
    found = _SOURCES.get((type(event_type), int(event_type)))
    if found is None:
        raise UnsupportedEventTypeError(f"there is no event {event_type!r}")
    source, status = found
    return source(handle, on_ready, status())
