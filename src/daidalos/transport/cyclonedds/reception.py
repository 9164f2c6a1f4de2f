"""Waiting for readers, and passing their samples on."""

from __future__ import annotations

import ctypes as c
import itertools
import logging
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

from daidalos.transport.cyclonedds.library import (
    ANY_STATE,
    DATA_AVAILABLE_STATUS,
    INFINITE,
    IoVector,
    Library,
    SampleInfo,
)
from daidalos.transport.cyclonedds.role import Role

_LOGGER = logging.getLogger(__name__)
_BATCH = 64
_WAKE = 0
_JOIN_S = 2.0
_PACE = 10
_MAX_PAUSE_NS = 500_000_000
_AT_ONCE_NS = 1
Result = TypeVar("Result")
Handler = Callable[[bool], bool | None]
"""What is called when something has come; see `Reception.add`."""


class Sample(NamedTuple):
    """Received sample: CDR bytes, source stamp (Unix time, ns) and the writer's handle."""

    data: bytes
    source_ns: int
    writer: int


class Reception:
    """Thread that waits for data on any number of readers, unless another thread that waits anyway does it.

    A message that its own executor receives wakes one thread instead of two. The executor takes over by `enter`, and
    calls `leave` before it runs callbacks; where it does not come back soon, the reception's own thread goes on.

    Parameters
    ----------
    library, participant
        The library and the participant whose readers are waited for.
    name
        The thread's.
    on_batch
        Called on the thread after what has come was handled, and after `wake`; returns the time in nanoseconds after
        which it is called again though nothing comes, `INFINITE` for never. Who uses it does not `enter`.
    """

    def __init__(
        self, library: Library, participant: int, name: str, on_batch: Callable[[], int] = lambda: INFINITE
    ) -> None:
        self._library = library
        self._on_batch = on_batch
        self._number = itertools.count(_WAKE + 1).__next__
        self._handlers: dict[int, Handler] = {}
        self._numbers: dict[int, int] = {}
        self._held_back: dict[int, None] = {}
        self._closed = False
        self._waitset = library.check(library.dds_create_waitset(participant), "make a waitset")
        self._guard = library.check(library.dds_create_guardcondition(participant), "make a guard condition")
        library.check(library.dds_waitset_attach(self._waitset, self._guard, _WAKE), "attach a guard condition")
        self._ready = (c.c_ssize_t * _BATCH)()
        self._role = Role()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, entity: int, on_event: Handler, status: int = DATA_AVAILABLE_STATUS) -> None:
        """Call `on_event` on the receiving thread whenever a status of a reader or writer is raised.

        Parameters
        ----------
        entity
            The reader or writer.
        on_event
            What resets the status: where data is available, by taking all samples. It is told whether it may wait
            for room in a queue, and returns whether everything was passed on; else it is called again.
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
        """End the wait, and call `on_batch`."""
        self._library.dds_set_guardcondition(self._guard, True)

    def close(self) -> None:
        """End the thread; nobody receives any more."""
        self._closed = True
        self.wake()
        self._role.end()
        if threading.current_thread() is not self._thread:
            self._thread.join(_JOIN_S)
            self._role.wait_until_free(_JOIN_S)

    def enter(self) -> bool:
        """Take over receiving; return False where the own thread does it at the moment, which then hands over soon."""
        if self._closed or not self._role.enter():
            return False
        if self._held_back:
            self._handle((), may_wait=False)
            if self._held_back:  # what has no room is another executor's
                self._role.give_back()
                return False
        return True

    def wait(self, timeout_ns: int) -> Sequence[int]:
        """Wait until something comes or `wake` is called, between `enter` and `leave`; return it for `handle`."""
        count = self._library.dds_waitset_wait(self._waitset, self._ready, _BATCH, timeout_ns)
        if count < 0:  # the participant was deleted: waiting again would return at once, for ever
            self._closed = True
        return self._ready[:count] if count > 0 else ()

    def handle(self, numbers: Sequence[int]) -> None:
        """Pass on what `wait` has returned, without waiting for room in a queue."""
        self._handle(numbers, may_wait=False)

    def leave(self) -> None:
        """Stop receiving."""
        self._role.leave()

    def _handle(self, numbers: Sequence[int], *, may_wait: bool) -> None:
        if self._held_back:
            numbers = [*self._held_back, *(number for number in numbers if number not in self._held_back)]
            self._held_back.clear()
        for number in numbers:
            if number == _WAKE:
                self._library.dds_set_guardcondition(self._guard, False)
                continue
            handler = self._handlers.get(number)
            if handler is not None and _call(handler, may_wait) is False:  # None where it was removed meanwhile
                self._held_back[number] = None

    def _run(self) -> None:
        while not self._closed:
            with self._role.own():
                timeout = 0 if self._held_back else INFINITE
                while not self._closed:
                    self._handle(self.wait(timeout), may_wait=True)
                    timeout = _call(self._on_batch) or INFINITE
                    if self._role.is_wanted:
                        break
            self._role.stand_by()


def _call(function: Callable[..., Result], *arguments: Any) -> Result | None:
    """Call a function; a failure is logged, since one bad entity must not silence all others."""
    try:
        return function(*arguments)
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
    """Reader of samples, for one thread at a time.

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
        self._refused: dict[int, Sequence[Sample]] = {}

    def take_all(self, reader: int, accept: Callable[[Sample], bool | None]) -> bool:
        """Pass the samples of a reader to `accept`; samples without data, such as disposals, are skipped.

        Parameters
        ----------
        reader
            The reader.
        accept
            Is called with each sample; what it refuses by returning False is offered again by the next call.

        Returns
        -------
        bool
            Whether all were accepted.
        """
        refused = self._refused.pop(reader, ())
        for index, sample in enumerate(refused):
            if accept(sample) is False:
                self._refused[reader] = refused[index:]
                return False
        library, infos, buffers = self._library, self._infos, self._buffers
        while True:
            count: int = library.dds_takecdr(reader, self._pointer, _BATCH, infos, ANY_STATE)
            kept: list[Sample] = []
            for index in range(count):
                info = infos[index]
                data = self._copy(buffers[index]) if info.valid_data else None
                library.ddsi_serdata_unref(buffers[index])
                if data is not None:
                    sample = Sample(data, info.source_timestamp, info.publication_handle)
                    if kept or accept(sample) is False:
                        kept.append(sample)
            if kept:
                self._refused[reader] = kept
                return False
            if count < _BATCH:
                return True

    def forget(self, reader: int) -> None:
        """Drop what was refused of a reader that is being deleted."""
        self._refused.pop(reader, None)

    def _copy(self, serialized: int | None) -> bytes:
        library, vector = self._library, self._vector
        size = library.ddsi_serdata_size(serialized)
        held = library.ddsi_serdata_to_ser_ref(serialized, 0, size, self._reference)
        data = c.string_at(vector.base, vector.length)
        library.ddsi_serdata_to_ser_unref(held, self._reference)
        return data
