"""Locks, semaphores' foundations and thread-local data for the threads of a lock-step run.

They have the interfaces of ``_thread``; conditions, events, semaphores and queues of the standard library are built on
them. Outside of the run's threads, where nobody else can run, they do not wait.
"""

from __future__ import annotations

import itertools
from collections import deque
from typing import Any, ClassVar

from daidalos.lockstep.scheduler import Scheduler, Thread, Wait

_TIMEOUT_MAX = float(2**62) * 1e-9
_numbers = itertools.count(1)


class Lock:
    """Lock that is handed on in the order in which threads asked for it.

    Attributes
    ----------
    holder : Thread or None
        The thread that has it, where that is sure to release it: within a ``with`` block.
    """

    scheduler: ClassVar[Scheduler]

    __slots__ = ("__weakref__", "_locked", "_waiting", "holder")

    def __init__(self) -> None:
        self._locked = False
        self._waiting: deque[Wait] | None = None
        self.holder: Thread | None = None

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock, and wait for it if need be; return whether it was taken.

        Raises
        ------
        ValueError
            For a timeout without waiting, or a negative one that is not -1.
        """
        if not self._locked:
            self._locked = True
            return True
        if timeout != -1:
            if not blocking:
                raise ValueError("can't specify a timeout for a non-blocking call")
            if timeout < 0:
                raise ValueError("timeout value must be a non-negative number")
        if not blocking or timeout == 0:
            return False
        return self._wait(timeout)

    def _wait(self, timeout: float) -> bool:
        scheduler = self.scheduler
        if scheduler.is_foreign:
            scheduler.wait_outside(lambda: self.acquire(blocking=False))
            return True
        wait = Wait(scheduler.running(), "a lock", self)
        if self._waiting is None:
            self._waiting = deque()
        self._waiting.append(wait)
        unlimited = timeout == -1 or timeout >= _TIMEOUT_MAX
        deadline = None if unlimited else scheduler.now_ns + max(round(1e9 * timeout), 1)
        try:
            taken = scheduler.wait(wait, deadline)
        except BaseException:
            if wait.woken and self._locked:  # a signal's handler may have released it already
                self.release()
            elif not wait.woken:
                self._waiting.remove(wait)
            raise
        if not taken:
            self._waiting.remove(wait)
        return taken

    def release(self) -> None:
        """Hand the lock to who has waited longest.

        Raises
        ------
        RuntimeError
            When nobody has it.
        """
        if not self._locked:
            raise RuntimeError("release unlocked lock")
        waiting = self._waiting
        while waiting:
            wait = waiting.popleft()
            if self.scheduler.wake(wait):
                self.holder = None
                return
        self._locked = False
        self.holder = None

    def locked(self) -> bool:
        """Return whether somebody has the lock."""
        return self._locked

    def __enter__(self) -> bool:
        if self._locked:
            self.acquire()
        else:
            self._locked = True
        self.holder = self.scheduler.current
        return True

    def __exit__(self, *exception: object) -> None:
        if self._waiting or not self._locked:
            self.release()
        else:
            self._locked = False
            self.holder = None

    def _at_fork_reinit(self) -> None:
        self._locked, self._waiting, self.holder = False, None, None

    acquire_lock, release_lock, locked_lock = acquire, release, locked


class RLock:
    """Lock that its holder may take again."""

    __slots__ = ("__weakref__", "_count", "_lock", "_owner")

    def __init__(self) -> None:
        self._lock = Lock()
        self._owner: Any = None
        self._count = 0

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock once more, and wait for it if need be; return whether it was taken."""
        me = Lock.scheduler.current or Lock.scheduler
        if self._owner is me:
            self._count += 1
            return True
        lock = self._lock
        if not lock._locked:
            lock._locked = True
        elif not lock.acquire(blocking, timeout):
            return False
        self._owner, self._count = me, 1
        lock.holder = me if me.__class__ is Thread else None
        return True

    __enter__ = acquire

    def release(self) -> None:
        """Give the lock back once.

        Raises
        ------
        RuntimeError
            When the calling thread does not have it.
        """
        if self._owner is not (Lock.scheduler.current or Lock.scheduler):
            raise RuntimeError("cannot release un-acquired lock")
        self._count -= 1
        if not self._count:
            self._owner = None
            self._lock.__exit__()

    def __exit__(self, *exception: object) -> None:
        self.release()

    # What conditions need.

    def _is_owned(self) -> bool:
        return self._owner is (Lock.scheduler.current or Lock.scheduler)

    def _release_save(self) -> tuple[int, Any]:
        state = self._count, self._owner
        self._count, self._owner = 0, None
        self._lock.release()
        return state

    def _acquire_restore(self, state: tuple[int, Any]) -> None:
        self._lock.acquire()
        self._count, self._owner = state

    def _recursion_count(self) -> int:
        return self._count if self._is_owned() else 0

    def _at_fork_reinit(self) -> None:
        self._lock._at_fork_reinit()
        self._owner, self._count = None, 0


class Local:
    """Data of each thread's own, as `threading.local`."""

    _outside: ClassVar[dict[int, dict[str, Any]]] = {}

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        """Create the data; the arguments are passed to ``__init__`` once for each thread."""
        self = super().__new__(cls)
        object.__setattr__(self, "_lockstep_init", (next(_numbers), args, kwargs))
        return self

    def __getattribute__(self, name: str) -> Any:
        _switch(self)
        return object.__getattribute__(self, name)

    def __setattr__(self, name: str, value: Any) -> None:
        _switch(self)
        object.__setattr__(self, name, value)

    def __delattr__(self, name: str) -> None:
        _switch(self)
        object.__delattr__(self, name)


def _switch(local: Local) -> None:
    """Make the attributes those of the thread that runs."""
    own = object.__getattribute__(local, "__dict__")
    created = own["_lockstep_init"]
    thread = Lock.scheduler.current
    all_data = Local._outside if thread is None else thread.locals
    data = all_data.get(created[0])
    if data is own:
        return
    if data is not None:
        object.__setattr__(local, "__dict__", data)
        return
    data = {"_lockstep_init": created}
    all_data[created[0]] = data
    object.__setattr__(local, "__dict__", data)
    kind = type(local)
    if kind.__init__ is not object.__init__:
        kind.__init__(local, *created[1], **created[2])
