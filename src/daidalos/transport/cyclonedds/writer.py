"""DDS writers of serialized samples, and the queue of samples that readers do not take in time."""

from __future__ import annotations

import ctypes as c
import logging
import threading
import time
from collections import deque
from typing import Any

from daidalos.interfaces.codec import CdrError
from daidalos.transport.cyclonedds.library import INFINITE, RETCODE_TIMEOUT, SERDATA_DATA, Buffer, Library

_LOGGER = logging.getLogger(__name__)
_PADDING = (b"", b"\0\0\0", b"\0\0", b"\0")
_MAX_JOINED_SIZE = 4096
"""Up to so many bytes the buffers of a sample are joined; larger ones are passed where they are."""
_ROOM_TIMEOUT_NS = 500_000_000
"""Longest time that a writer waits for room in its queue."""
_LOG_INTERVAL_NS = 5_000_000_000


class Writer:
    """A DDS writer of serialized samples.

    A reader that does not keep up blocks `write` for at most `qos.BLOCKING_NS`. Samples that it has not
    taken by then wait in a queue as long as the history, which a thread empties: what is within the history's depth is
    delivered. A full queue blocks `write` for at most `_ROOM_TIMEOUT_NS`; samples beyond it are dropped, oldest first,
    counted and logged.

    Parameters
    ----------
    library
        The C library.
    entity
        Handle of the writer.
    name
        Name of the topic or service, for messages.
    limit
        Depth of the history; None keeps all samples and blocks the caller instead.
    keeps_newest
        Whether a sample replaces those before: the oldest is dropped from a full queue at once, and not counted.

    Attributes
    ----------
    dropped
        Number of samples that were dropped.
    """

    def __init__(
        self, library: Library, entity: int, name: str, limit: int | None, *, keeps_newest: bool = False
    ) -> None:
        self._library = library
        self._keeps_newest = keeps_newest
        self.entity = entity
        self.dropped = 0
        self._name = name
        self._limit = limit
        self._type = c.c_void_p()
        library.check(library.dds_get_entity_sertype(entity, c.byref(self._type)), "find a writer's type")
        # A sample does not keep its type alive: the writer may not be deleted between the making of a sample and its
        # write. The lock is reentrant since a signal's handler may close the writer that its own thread is using.
        self._lock = threading.RLock()
        self._closed = False
        self._queue: deque[bytes] = deque()
        self._queue_changed = threading.Condition()
        self._has_thread = False
        self._congested_until = 0
        self._logged_at = -_LOG_INTERVAL_NS

    def write(self, parts: list[Any]) -> None:
        """Write one sample, given as buffers; after `close`, nothing is written.

        Raises
        ------
        CdrError
            When the library refuses the sample.
        """
        if self._has_thread and self._append(parts):
            return
        size, count, buffers = _buffers(parts)
        while not self._closed:
            if self._write(size, count, buffers):
                return
            if self._limit is not None:
                self._append(parts, first=True)
                return

    def _write(self, size: int, count: int, buffers: Any) -> bool:
        """Write one sample; return whether it was taken within `qos.BLOCKING_NS`."""
        library = self._library
        with self._lock:
            if self._closed:
                return True
            serialized = library.ddsi_serdata_from_ser_iov(self._type, SERDATA_DATA, count, buffers, size)
            if not serialized:
                raise CdrError(f"DDS refused a sample of {size} bytes on '{self._name}'")
            result: int = library.dds_writecdr(self.entity, serialized)
        return result != RETCODE_TIMEOUT

    def _append(self, parts: list[Any], *, first: bool = False) -> bool:
        """Queue a sample, if `first` or a thread is emptying the queue; return whether it was queued.

        Where the queue is full, its oldest sample is dropped after `_ROOM_TIMEOUT_NS`, and for as long again without
        a wait, so that one stopped process does not stop its publishers.
        """
        with self._queue_changed:
            if self._queue and len(self._queue) == self._limit:
                if self._keeps_newest:
                    self._queue.popleft()
                elif not self._wait_for_room():
                    self._queue.popleft()
                    self._count_dropped()
            if not self._has_thread:  # it may have ended during the wait
                if not first:
                    return False
                self._has_thread = True
                threading.Thread(target=self._empty_queue, name="dds-writer", daemon=True).start()
            self._queue.append(b"".join(bytes(memoryview(part).cast("B")) for part in parts))
            return True

    def _wait_for_room(self) -> bool:
        """Wait until the queue is not full; return whether it is so in time."""
        if time.monotonic_ns() < self._congested_until:
            return False
        if self._queue_changed.wait_for(lambda: len(self._queue) != self._limit, _ROOM_TIMEOUT_NS * 1e-9):
            return True
        self._congested_until = time.monotonic_ns() + _ROOM_TIMEOUT_NS
        return False

    def _count_dropped(self) -> None:
        self.dropped += 1
        now = time.monotonic_ns()
        if now - self._logged_at >= _LOG_INTERVAL_NS:
            self._logged_at = now
            _LOGGER.warning(
                "dropped %d message(s) on '%s' so far: a reliable subscription does not keep up, and the history's "
                "depth of the publisher is %d",
                self.dropped,
                self._name,
                self._limit,
            )

    def _empty_queue(self) -> None:
        """Write the queued samples in order until none is left."""
        while True:
            with self._queue_changed:
                if self._closed or not self._queue:
                    self._queue.clear()
                    self._has_thread = False
                    self._queue_changed.notify_all()
                    return
                sample = self._queue[0]
            try:
                taken = self._write(*_buffers([sample]))
            except CdrError as error:
                taken = True  # it would block those behind it for ever
                self.dropped += 1
                _LOGGER.error("dropped a message: %s", error)
            if taken:
                with self._queue_changed:
                    if self._queue and self._queue[0] is sample:
                        self._queue.popleft()
                        self._queue_changed.notify_all()

    def wait_for_acks(self, timeout_ns: int | None) -> bool:
        """Wait until all reliable readers have acknowledged what was written.

        Parameters
        ----------
        timeout_ns
            Longest time to wait; None for as long as it takes.

        Returns
        -------
        bool
            Whether they have.
        """
        deadline = None if timeout_ns is None else time.monotonic_ns() + timeout_ns
        with self._queue_changed:
            timeout_s = None if timeout_ns is None else timeout_ns * 1e-9
            if not self._queue_changed.wait_for(lambda: not self._has_thread, timeout_s):
                return False
        if self._closed:
            return True
        library = self._library
        left = INFINITE if deadline is None else max(deadline - time.monotonic_ns(), 0)
        result = library.dds_wait_for_acks(self.entity, left)
        if result == RETCODE_TIMEOUT:
            return False
        library.check(result, "wait for acknowledgements")
        return True

    def close(self) -> None:
        """Delete the writer; what is still queued is dropped."""
        self._closed = True
        with self._lock:
            self._library.dds_delete(self.entity)


def _buffers(parts: list[Any]) -> tuple[int, int, Any]:
    """Return (size, count, C's list) of buffers padded to a multiple of four bytes.

    Large buffers stay where they are: they must outlive the list.
    """
    if sum(map(len, parts)) <= _MAX_JOINED_SIZE:
        data = b"".join(parts)
        data += _PADDING[len(data) & 3]
        return len(data), 1, c.byref(Buffer(data, len(data)))
    addressed = [(part, len(part)) if isinstance(part, bytes) else _address(part) for part in parts]
    size = sum(length for _, length in addressed)
    if size & 3:
        addressed.append((_PADDING[size & 3], -size & 3))
    return (
        size + (-size & 3),
        len(addressed),
        (Buffer * len(addressed))(*(Buffer(base, length) for base, length in addressed)),
    )


def _address(part: Any) -> tuple[int, int]:
    """Return (address, size) of an array's bytes."""
    address, count = part.buffer_info()
    return address, count * part.itemsize
