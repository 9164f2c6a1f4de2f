"""Conversion of QoS profiles to and from DDS."""

from __future__ import annotations

import ctypes as c
from collections.abc import Iterator
from contextlib import contextmanager

from daidalos.transport.cyclonedds.library import INFINITE, Library
from daidalos.transport.cyclonedds.names import read_user_data
from daidalos.transport.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability

UNLIMITED = -1
BLOCKING_NS = 100_000_000
"""Longest time that one call of a reliable writer waits for readers that do not keep up, in nanoseconds."""
_READER_SAMPLES = 256
"""Samples that wait for the receiving thread; when there are more, the writer is held back."""

_KEEP_LAST, _KEEP_ALL = 0, 1
_BEST_EFFORT, _RELIABLE = 0, 1
_VOLATILE, _TRANSIENT_LOCAL = 0, 1
_IGNORE_PARTICIPANT = 1
_LIVELINESS = {Liveliness.AUTOMATIC: 0, Liveliness.MANUAL_BY_NODE: 1, Liveliness.MANUAL_BY_TOPIC: 2}
_LIVELINESS_BACK = {value: key for key, value in _LIVELINESS.items()}
HISTORY_KEY = "history"
"""Under this key user data tell the history that was asked for."""


def history_text(qos: Qos) -> str:
    """Return the history for user data; DDS itself keeps all for reliable writers and readers."""
    return f"{int(qos.history)},{qos.depth}"


@contextmanager
def dds_qos(library: Library, qos: Qos, user_data: bytes, *, writes: bool) -> Iterator[int]:
    """Yield a DDS profile for a writer or reader; it is freed afterwards.

    What is reliable keeps all until it was acknowledged, so that a writer waits instead of overwriting: the
    depth limits what late readers get and what waits for callbacks.
    """
    handle = library.dds_create_qos()
    try:
        depth = 0 if qos.limit is None else qos.limit
        if qos.reliable or qos.limit is None:
            library.dds_qset_history(handle, _KEEP_ALL, 0)
            if not writes:
                library.dds_qset_resource_limits(handle, _READER_SAMPLES, UNLIMITED, UNLIMITED)
        else:
            library.dds_qset_history(handle, _KEEP_LAST, depth)
        if qos.reliable:
            library.dds_qset_reliability(handle, _RELIABLE, BLOCKING_NS)
        else:
            library.dds_qset_reliability(handle, _BEST_EFFORT, 0)
        if qos.transient_local:
            kept = (_KEEP_LAST, depth) if depth else (_KEEP_ALL, UNLIMITED)
            library.dds_qset_durability(handle, _TRANSIENT_LOCAL)
            library.dds_qset_durability_service(handle, 0, *kept, UNLIMITED, UNLIMITED, UNLIMITED)
        library.dds_qset_deadline(handle, _limited(qos.deadline_ns))
        library.dds_qset_liveliness(handle, _LIVELINESS.get(qos.liveliness, 0), _limited(qos.liveliness_lease_ns))
        if writes:
            library.dds_qset_lifespan(handle, _limited(qos.lifespan_ns))
            library.dds_qset_writer_data_lifecycle(handle, False)
        library.dds_qset_ignorelocal(handle, _IGNORE_PARTICIPANT)  # the session delivers within the process
        library.dds_qset_userdata(handle, user_data, len(user_data))
        yield handle
    finally:
        library.dds_delete_qos(handle)


def _limited(duration_ns: int) -> int:
    return INFINITE if duration_ns in (0, INFINITE_NS) else duration_ns


def user_data_of(library: Library, handle: int | None) -> dict[str, str]:
    """Return the pairs in a profile's user data."""
    value, size = c.c_void_p(), c.c_size_t()
    if not handle or not library.dds_qget_userdata(handle, c.byref(value), c.byref(size)) or not value:
        return {}
    data = c.string_at(value.value or 0, size.value)
    library.dds_free(value)
    return read_user_data(data)


def read_qos(library: Library, handle: int, user_data: dict[str, str]) -> Qos:
    """Return the profile of a remote writer or reader."""
    kind, number = c.c_int(), c.c_int32()
    duration, lease = c.c_int64(), c.c_int64()
    reliable = bool(library.dds_qget_reliability(handle, c.byref(kind), c.byref(duration))) and kind.value == _RELIABLE
    kept = library.dds_qget_durability(handle, c.byref(kind)) and kind.value != _VOLATILE
    history, depth = History.KEEP_LAST, 1
    if library.dds_qget_history(handle, c.byref(kind), c.byref(number)):
        history = History.KEEP_ALL if kind.value == _KEEP_ALL else History.KEEP_LAST
        depth = max(number.value, 0)
    asked = user_data.get(HISTORY_KEY, "").split(",")
    if len(asked) == 2 and all(part.isdigit() for part in asked) and int(asked[0]) in (1, 2):
        history, depth = History(int(asked[0])), int(asked[1])
    deadline = duration.value if library.dds_qget_deadline(handle, c.byref(duration)) else INFINITE
    lifespan = duration.value if library.dds_qget_lifespan(handle, c.byref(duration)) else INFINITE
    liveliness = Liveliness.AUTOMATIC
    if library.dds_qget_liveliness(handle, c.byref(kind), c.byref(lease)):
        liveliness = _LIVELINESS_BACK.get(kind.value, Liveliness.AUTOMATIC)
    else:
        lease.value = INFINITE
    return Qos(
        Reliability.RELIABLE if reliable else Reliability.BEST_EFFORT,
        Durability.TRANSIENT_LOCAL if kept else Durability.VOLATILE,
        history,
        depth,
        min(deadline, INFINITE_NS),
        min(lifespan, INFINITE_NS),
        liveliness,
        min(lease.value, INFINITE_NS),
    )
