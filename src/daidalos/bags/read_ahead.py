"""Prefetching of messages in a thread."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from itertools import islice
from queue import Full, Queue

from daidalos.bags.message import BagMessage

_BATCH = 50
_POLL_S = 0.2


class ReadAhead:
    """Iterator that prefetches up to about `size` messages.

    Parameters
    ----------
    messages
        Where they come from; used by the thread alone until `close` has returned.
    size
        How many are kept at most.
    """

    def __init__(self, messages: Iterator[BagMessage], size: int) -> None:
        self._messages = messages
        self._queue: Queue[list[BagMessage] | BaseException] = Queue(max(size // _BATCH, 1))
        self._closed = threading.Event()
        self._batch: Iterator[BagMessage] = iter(())
        self._ended = False
        self._thread = threading.Thread(target=self._read, name="read ahead", daemon=True)
        self._thread.start()

    def next(self) -> BagMessage | None:
        """Return the next message, None at the end; re-raise what the iterator raised."""
        while True:
            message = next(self._batch, None)
            if message is not None or self._ended:
                return message
            item = self._queue.get()
            if isinstance(item, BaseException):
                self._ended = True
                raise item
            self._ended = not item
            self._batch = iter(item)

    def close(self) -> None:
        """Stop reading."""
        self._closed.set()
        self._thread.join()

    def _read(self) -> None:
        error: Exception | None = None
        while error is None and not self._closed.is_set():
            batch: list[BagMessage] = []
            try:
                batch.extend(islice(self._messages, _BATCH))
            except Exception as raised:  # re-raised by `next`
                error = raised
            if batch or error is None:
                self._put(batch)
            if error is not None:
                self._put(error)
            if not batch:
                return

    def _put(self, item: list[BagMessage] | BaseException) -> None:
        while not self._closed.is_set():
            try:
                self._queue.put(item, timeout=_POLL_S)
                return
            except Full:
                continue
