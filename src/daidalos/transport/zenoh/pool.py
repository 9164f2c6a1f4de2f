"""Shared memory for large messages, written without zenoh's intermediate copy."""

from __future__ import annotations

import contextlib
import threading
import time
from typing import Any

import zenoh

from daidalos.transport.zenoh.config import shared_memory_usable

SHM_THRESHOLD = 65536
"""Size in bytes from which shared memory is faster than zenoh's copy."""
_SIZE = 16 * 2**20
_TIMEOUT_S = 1.0


class Pool:
    """Shared memory of a session for messages in transit, 16 MB in all, allocated on first use.

    What a receiver holds when it is killed is never given back. Memory that was full for a while is therefore
    replaced; in case it is a receiver that lives and holds on, after twice as long each time.

    Parameters
    ----------
    enabled
        Whether the session shares memory with its peers.
    """

    def __init__(self, enabled: bool) -> None:
        self._enabled = enabled
        self._lock = threading.Lock()
        self._provider: Any = None
        self._full_since: float | None = None
        self._timeout = _TIMEOUT_S

    def place(self, data: bytes) -> Any:
        """Return a large message in shared memory; return it unchanged if it is small or the pool is full."""
        size = len(data)
        if size < SHM_THRESHOLD or size > _SIZE or not self._enabled:
            return data
        with self._lock:
            if self._provider is None and not self._open():
                return data
            memory = self._find(size)
            if memory is None:
                self._note_full()
                return data
            self._full_since = None
        memory[0:size] = data
        return memory

    def _open(self) -> bool:
        from zenoh import shm

        self._enabled = shared_memory_usable()
        if self._enabled:
            try:
                self._provider = shm.ShmProvider.default_backend(_SIZE)
            except zenoh.ZError:
                self._enabled = False
            self._policy = shm.GarbageCollect()
        return self._enabled

    def _find(self, size: int) -> Any:
        """Return free memory, None if there is none; adjacent free blocks are merged if needed."""
        with contextlib.suppress(zenoh.ZError):
            return self._provider.alloc(size, self._policy)
        self._provider.defragment()
        with contextlib.suppress(zenoh.ZError):
            return self._provider.alloc(size, self._policy)
        return None

    def _note_full(self) -> None:
        now = time.monotonic()
        if self._full_since is None:
            self._full_since = now
        elif now - self._full_since > self._timeout:
            self._provider = self._full_since = None
            self._timeout *= 2
