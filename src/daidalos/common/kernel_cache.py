"""Numba's cache on disk, for processes that start at the same time."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import IO, Any

from numba.core.caching import FunctionCache

from daidalos.common.file_locks import lock_file


class SharedCache(FunctionCache):  # type: ignore[misc]  # numba has no types
    """Cache of a function's machine code, which one process at a time compiles.

    A function is looked up before it is compiled. Where it is absent, the cache stays locked until `unlock`, and who
    has waited for the lock finds what the process before it has compiled. Functions are locked before those that they
    call, never the other way round, and by one thread of a process at a time, as numba compiles in one; so processes
    do not wait for each other in a circle.
    """

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        self._lock: IO[bytes] | None = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function, waiting for a process that compiles it; None where it is to be compiled."""
        found = super().load_overload(sig, target_context)
        if found is not None or self._lock is not None:
            return found
        # Where the folder of the cache cannot be written, nobody can wait for what others write there.
        with contextlib.suppress(OSError):
            self._impl.locator.ensure_cache_path()
            self._lock = self._lock_path.open("ab")
            lock_file(self._lock, wait=True)
        return super().load_overload(sig, target_context)

    @property
    def _lock_path(self) -> Path:
        return Path(self.cache_path) / f"{self._impl.filename_base}.lock"

    def unlock(self) -> None:
        """Release the lock, so that other processes look again."""
        if self._lock is None:
            return
        if os.name == "posix":  # elsewhere a file that others wait for cannot be removed
            self._lock_path.unlink(missing_ok=True)
        self._lock.close()
        self._lock = None
