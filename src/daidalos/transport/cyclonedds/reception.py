"""Receiving thread that waits for readers and passes their samples on."""

from __future__ import annotations

import ctypes as c
import itertools
import logging
import threading
import time
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from daidalos.transport.cyclonedds.library import (
    ANY_STATE,
    DATA_AVAILABLE_STATUS,
    INFINITE,
    IoVector,
    Library,
    SampleInfo,
)

_LOGGER = logging.getLogger(__name__)
_BATCH = 64
_WAKE = 0
_JOIN_S = 2.0
_PACE = 10
_MAX_PAUSE_NS = 500_000_000
_AT_ONCE_NS = 1
Result = TypeVar("Result")


class Sample(NamedTuple):
    """Received sample: CDR bytes, source stamp (Unix time, ns) and the writer's handle."""

    data: bytes
    source_ns: int
    writer: int


class Reception:
    """Thread that waits for data on any number of readers.

    Parameters
    ----------
    library, participant
        The library and the participant whose readers are waited for.
    name
        The thread's.
    on_batch
        Called on the thread after what has come was handled, and after `wake`; returns the time in nanoseconds after
        which it is called again though nothing comes, `INFINITE` for never.
    """

    def __init__(
        self, library: Library, participant: int, name: str, on_batch: Callable[[], int] = lambda: INFINITE
    ) -> None:
        self._library = library
        self._on_batch = on_batch
        self._number = itertools.count(_WAKE + 1).__next__
        self._handlers: dict[int, Callable[[], None]] = {}
        self._numbers: dict[int, int] = {}
        self._closed = False
        self._waitset = library.check(library.dds_create_waitset(participant), "make a waitset")
        self._guard = library.check(library.dds_create_guardcondition(participant), "make a guard condition")
        library.check(library.dds_waitset_attach(self._waitset, self._guard, _WAKE), "attach a guard condition")
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, entity: int, on_event: Callable[[], None], status: int = DATA_AVAILABLE_STATUS) -> None:
        """Call `on_event` on the thread whenever a status of a reader or writer is raised.

        Parameters
        ----------
        entity
            The reader or writer.
        on_event
            What resets the status: where data is available, by taking all samples.
        status
            The status that is waited for.
        """
        library = self._library
        number = self._numbers[entity] = self._number()
        self._handlers[number] = on_event
        library.check(library.dds_set_status_mask(entity, status), "watch an entity")
        library.check(library.dds_waitset_attach(self._waitset, entity, number), "watch an entity")

    def remove(self, reader: int) -> None:
        """Stop waiting for a reader."""
        number = self._numbers.pop(reader, None)
        if number is not None:
            self._handlers.pop(number, None)
            self._library.dds_waitset_detach(self._waitset, reader)

    def wake(self) -> None:
        """Call `on_batch` on the thread."""
        self._library.dds_set_guardcondition(self._guard, True)

    def close(self) -> None:
        """End the thread."""
        self._closed = True
        self.wake()
        if threading.current_thread() is not self._thread:
            self._thread.join(_JOIN_S)

    def _run(self) -> None:
        library, numbers = self._library, (c.c_ssize_t * _BATCH)()
        timeout = INFINITE
        while not self._closed:
            count = library.dds_waitset_wait(self._waitset, numbers, _BATCH, timeout)
            if count < 0:
                return
            for number in numbers[:count]:
                if number == _WAKE:
                    library.dds_set_guardcondition(self._guard, False)
                    if self._closed:
                        return
                    continue
                handler = self._handlers.get(number)
                if handler is not None:  # else removed meanwhile
                    _call(handler)
            timeout = _call(self._on_batch) or INFINITE


def _call(function: Callable[[], Result]) -> Result | None:
    """Call a function; a failure is logged, since one bad entity must not silence all others."""
    try:
        return function()
    except Exception:
        _LOGGER.exception("receiving failed")
        return None


class Paced:
    """Work that grows with what is known, done at most so often that it takes a tenth of the time.

    Parameters
    ----------
    work
        What is done, on the thread that calls `run`.
    """

    def __init__(self, work: Callable[[], None]) -> None:
        self._work = work
        self._pending = False
        self._next_ns = 0

    def request(self) -> None:
        """Schedule the work at the next `run` that is late enough; from any thread."""
        self._pending = True

    def run(self) -> int:
        """Do the work if it is requested and due; return the nanoseconds until it is due, `INFINITE` for never."""
        if not self._pending:
            return INFINITE
        begin = time.monotonic_ns()
        if begin < self._next_ns:
            return self._next_ns - begin
        self._pending = False
        used = time.thread_time_ns()  # a thread without a processor does not do much work
        self._work()
        used = time.thread_time_ns() - used
        self._next_ns = time.monotonic_ns() + min(_PACE * used, _MAX_PAUSE_NS)
        return _AT_ONCE_NS if self._pending else INFINITE


class SampleReader:
    """Reader of samples for a single thread.

    Parameters
    ----------
    library
        The library.
    """

    def __init__(self, library: Library) -> None:
        self._library = library
        self._buffers = (c.c_void_p * _BATCH)()
        self._pointer = c.cast(self._buffers, c.POINTER(c.c_void_p))
        self._infos = (SampleInfo * _BATCH)()
        self._vector = IoVector()
        self._reference = c.byref(self._vector)

    def take_all(self, reader: int, accept: Callable[[Sample], None]) -> None:
        """Pass every sample of a reader to `accept`; samples without data, such as disposals, are skipped."""
        library, infos, buffers = self._library, self._infos, self._buffers
        while True:
            count: int = library.dds_takecdr(reader, self._pointer, _BATCH, infos, ANY_STATE)
            for index in range(count):
                info = infos[index]
                data = self._copy(buffers[index]) if info.valid_data else None
                library.ddsi_serdata_unref(buffers[index])
                if data is not None:
                    accept(Sample(data, info.source_timestamp, info.publication_handle))
            if count < _BATCH:
                return

    def _copy(self, serialized: int | None) -> bytes:
        library, vector = self._library, self._vector
        size = library.ddsi_serdata_size(serialized)
        held = library.ddsi_serdata_to_ser_ref(serialized, 0, size, self._reference)
        data = c.string_at(vector.base, vector.length)
        library.ddsi_serdata_to_ser_unref(held, self._reference)
        return data
