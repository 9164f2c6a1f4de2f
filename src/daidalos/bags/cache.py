"""Buffers between receiving threads and the disk: a bounded queue, or a snapshot of the last messages."""

from __future__ import annotations

import threading
from collections import Counter, deque
from collections.abc import Callable

from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage
from daidalos.bags.writer import BagWriter

_OVERHEAD = 100
"""Bytes that a queued message takes beside its data."""
_GATHER_S = 0.06
"""Time for which messages are collected before they are passed to the operating system: a process that is killed loses
no more than the last 100 ms, and the thread is not woken for each message."""
_GATHER_BYTES = 4 * 1024 * 1024
"""Nor does it wait longer when there are so many bytes."""


class WriterThread:
    """Thread that writes messages to a bag.

    Parameters
    ----------
    writer
        The bag.
    max_size
        How many bytes may wait; what comes when there are more is lost. 0 for no limit.
    on_error
        Called, on the thread, when the bag cannot be written any more.

    Attributes
    ----------
    lost : Counter
        How many messages were lost, by topic.
    """

    def __init__(self, writer: BagWriter, max_size: int, on_error: Callable[[BagError], None]) -> None:
        self.writer = writer
        self.lost: Counter[str] = Counter()
        self._max_size = max_size
        self._on_error = on_error
        self._queue: deque[BagMessage | Callable[[], None]] = deque()
        self._size = 0
        self._lock = threading.Lock()
        self._begun = threading.Event()
        self._urgent = threading.Event()
        self._ending = False
        self._failed = False
        self._thread = threading.Thread(target=self._run, name="bag writer", daemon=True)
        self._thread.start()

    def write(self, message: BagMessage) -> None:
        """Queue a message."""
        size = len(message.data) + _OVERHEAD
        if self._failed or (self._max_size and self._size + size > self._max_size):
            self.lost[message.topic] += 1
            return
        with self._lock:
            self._size += size
            self._queue.append(message)
        if not self._begun.is_set():
            self._begun.set()
        if self._size > _GATHER_BYTES:
            self._urgent.set()

    def call(self, work: Callable[[], None]) -> None:
        """Call a function with the writer after everything queued before, and wait for it."""
        done = threading.Event()

        def item() -> None:
            try:
                work()
            finally:
                done.set()

        with self._lock:
            if self._ending:
                return
            self._queue.append(item)
        self._wake()
        done.wait()

    def close(self) -> None:
        """Write what is queued and end the thread; the bag stays open."""
        with self._lock:
            self._ending = True
        self._wake()
        self._thread.join()

    def _wake(self) -> None:
        self._urgent.set()
        self._begun.set()

    def _run(self) -> None:
        while True:
            self._begun.wait()
            self._urgent.wait(_GATHER_S)
            self._begun.clear()
            self._urgent.clear()
            with self._lock:
                batch, self._queue, self._size = self._queue, deque(), 0
                ending = self._ending and not batch
                if self._ending:
                    self._begun.set()
                    self._urgent.set()
            if ending:
                return
            self._write_pending(batch)

    def _write_pending(self, batch: deque[BagMessage | Callable[[], None]]) -> None:
        for item in batch:
            if isinstance(item, BagMessage):
                self._write(item)
            else:
                self._attempt(item)
        if batch and not self._failed:
            self._attempt(self.writer.flush)

    def _write(self, message: BagMessage) -> None:
        if self._failed:
            self.lost[message.topic] += 1
            return
        try:
            self.writer.write(message)
        except BagError as error:
            self._fail(error)

    def _attempt(self, work: Callable[[], None]) -> None:
        try:
            work()
        except BagError as error:
            self._fail(error)

    def _fail(self, error: BagError) -> None:
        """Report an error once and discard all further messages."""
        if not self._failed:
            self._failed = True
            self._on_error(error)


class SnapshotBuffer:
    """Ring buffer of the last messages, written to a file on request.

    Parameters
    ----------
    writer
        The bag.
    max_size
        How many bytes are kept.
    """

    def __init__(self, writer: BagWriter, max_size: int) -> None:
        self.writer = writer
        self.lost: Counter[str] = Counter()
        self._max_size = max_size
        self._kept: deque[BagMessage] = deque()
        self._size = 0
        self._lock = threading.Lock()

    def write(self, message: BagMessage) -> None:
        """Store a message, and drop the oldest ones that exceed the size."""
        with self._lock:
            self._kept.append(message)
            self._size += len(message.data) + _OVERHEAD
            while self._size > self._max_size and len(self._kept) > 1:
                self._size -= len(self._kept.popleft().data) + _OVERHEAD

    def call(self, work: Callable[[], None]) -> None:
        """Call a function with the writer."""
        work()

    def take(self) -> bool:
        """Write the stored messages to a file of its own; return False when there are none."""
        with self._lock:
            kept, self._kept, self._size = self._kept, deque(), 0
        if kept and not self.writer.is_file_empty:
            self.writer.split()
        for message in kept:
            self.writer.write(message)
        self.writer.flush()
        return bool(kept)

    def close(self) -> None:
        """Drop the stored messages."""
        self._kept.clear()
