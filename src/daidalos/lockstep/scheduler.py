"""Scheduler of the threads of a lock-step run.

Threads are greenlets of one thread of the system, so that the system decides nothing: a thread runs until it waits, and
then hands on. Those that can run do so in the order in which they were woken; when none can, the time advances to the
earliest deadline. Computing takes no time: the clock stands still while a thread runs.
"""

from __future__ import annotations

import _thread
import asyncio
import heapq
import itertools
import time
import traceback
from collections import deque
from collections.abc import Callable
from types import FrameType
from typing import Any

from greenlet import getcurrent, greenlet

from daidalos.common.errors import UserError

EPOCH_NS = 1_577_836_800_000_000_000
"""Unix time [ns] at which every run starts: 2020-01-01."""

MAX_SWITCHES = 2_000_000
"""Number of switches at one instant after which a run has come to a standstill."""

MAX_READS = 2000
"""Number of times that a thread may read the clock before the time advances, so that busy waiting ends."""

READING_NS = 100_000
"""Time [ns] by which the clock advances when a thread has read it too often."""


FIRST_IDENT = 0x10000
"""What `threading.get_ident` returns outside of the run's threads; those have the numbers above."""

_real_ident = _thread.get_ident
_real_sleep = time.sleep
_POLL_S = 0.0005


class LockstepError(UserError):
    """The run cannot go on: all threads wait for each other, or some never stop."""


class Owner:
    """What threads belong to: a program of the run, which hooks its own state in.

    Attributes
    ----------
    name : str
        For messages.
    """

    name = "main"

    def enter(self) -> None:
        """Install the state of the program; called before one of its threads runs after one of another."""

    def leave(self) -> None:
        """Save the state of the program."""

    def on_resume(self, thread: Thread) -> None:
        """Handle what is pending for a thread that runs again after waiting, such as signals."""


class Wait:
    """One wait of a thread, by which others wake it.

    Attributes
    ----------
    thread : Thread
    what : str
        What it waits for, for messages.
    lock : object
        The lock that it waits for, None for anything else; its `holder` is the thread that has it.
    since_ns : int
        Time [ns] at which it began.
    woken : bool
        Whether it has come.
    """

    __slots__ = ("lock", "since_ns", "thread", "what", "woken")

    def __init__(self, thread: Thread, what: str, lock: Any = None) -> None:
        self.thread = thread
        self.what = what
        self.lock = lock
        self.since_ns = thread.scheduler.now_ns
        self.woken = False


class Thread(greenlet):
    """A thread of a run.

    Parameters
    ----------
    scheduler : Scheduler
    function : callable
        Takes no arguments.
    owner : Owner
    name : str

    Attributes
    ----------
    waiting : Wait or None
        What it waits for, while it waits.
    locals : dict
        Its thread-local data.
    on_end : list of callable
        Called when it has ended.
    """

    def __init__(self, scheduler: Scheduler, function: Callable[[], Any], owner: Owner, name: str = "") -> None:
        super().__init__(parent=scheduler.hub)
        self.scheduler = scheduler
        self.owner = owner
        self.number = scheduler.next_number()
        self.name = name or f"thread {self.number}"
        self.waiting: Wait | None = None
        self.locals: dict[int, dict[str, Any]] = {}
        self.reads = 0
        self.ended = False
        self.started = False
        self.on_end: list[Callable[[], None]] = []
        self._function = function

    @property
    def ident(self) -> int:
        """What `threading.get_ident` returns in it."""
        return FIRST_IDENT + self.number

    def run(self) -> None:
        """Run the function, and then whatever waits for the end."""
        asyncio._set_running_loop(None)
        try:
            self._function()
        finally:
            self.ended = True
            self.scheduler.threads.pop(self.number, None)
            for callback in self.on_end:
                callback()

    def stack(self) -> str:
        """Return where the thread waits, as a traceback has it."""
        frame: FrameType | None = self.gr_frame
        return "".join(traceback.format_stack(frame)) if frame is not None else ""


_Entry = tuple[Thread, Wait | None]


class Scheduler:
    """Scheduler of a run.

    Attributes
    ----------
    now_ns : int
        Time since the start of the run [ns].
    threads : dict
        The threads that have not ended, by number.
    current : Thread or None
        The one that runs.
    switches : int
        How often one thread followed another.
    on_advance : callable or None
        Called with the time [ns] before, whenever the time has advanced.
    """

    def __init__(self) -> None:
        self.now_ns = 0
        self.switches = 0
        self.threads: dict[int, Thread] = {}
        self.hub = getcurrent()
        self.current: Thread | None = None
        self.on_advance: Callable[[int], None] | None = None
        self._error: BaseException | None = None
        self._ready: deque[_Entry] = deque()
        self._deadlines: list[tuple[int, int, Wait]] = []
        self._numbers = itertools.count(1)
        self._order = itertools.count()
        self._owner: Owner | None = None
        self._starting: Thread | None = None
        self._at_instant = 0
        self._busy: dict[str, int] = {}
        self._stopped = False
        self._ident = _real_ident()
        self._abandoned: list[Thread] = []

    def next_number(self) -> int:
        """Return the next thread's number."""
        return next(self._numbers)

    # Threads.

    def spawn(self, function: Callable[[], Any], owner: Owner, name: str = "") -> Thread:
        """Create a thread that runs after those that are ready now."""
        thread = Thread(self, function, owner, name)
        self.threads[thread.number] = thread
        self._ready.append((thread, None))
        return thread

    def abandon(self, thread: Thread) -> None:
        """Run a thread no more, as the end of a process does with its daemon threads."""
        if not thread.ended and thread is not self.current:
            thread.ended = True
            self.threads.pop(thread.number, None)
            self._abandoned.append(thread)  # its clean-up would run where it is collected

    # Waiting.

    def wait(self, wait: Wait, deadline_ns: int | None = None) -> bool:
        """Suspend the calling thread until `wake` is called for its wait or the time comes.

        Parameters
        ----------
        wait : Wait
            A new one of the calling thread.
        deadline_ns : int or None
            [ns]; None for as long as it takes.

        Returns
        -------
        bool
            Whether it was woken.
        """
        thread = wait.thread
        outer, thread.waiting = thread.waiting, wait
        if deadline_ns is not None:
            heapq.heappush(self._deadlines, (deadline_ns, next(self._order), wait))
        elif wait.lock is not None:
            self._refuse_deadlock(thread)
        try:
            while True:
                self.switch_to_next(thread)
                thread.owner.on_resume(thread)
                if wait.woken or (deadline_ns is not None and self.now_ns >= deadline_ns):
                    return wait.woken
        finally:
            thread.waiting = outer

    def wake(self, wait: Wait) -> bool:
        """Make a thread ready that waits; return False when it was woken already or has ended."""
        if wait.woken or wait.thread.ended:
            return False
        wait.woken = True
        self._ready.append((wait.thread, wait))
        return True

    def interrupt(self, thread: Thread) -> None:
        """Make a waiting thread handle what is pending for it; it goes on waiting afterwards."""
        if thread.waiting is not None:
            self._ready.append((thread, None))

    def sleep_until(self, deadline_ns: int) -> None:
        """Suspend the calling thread until a time [ns]; others run first if the time has come already."""
        self.wait(Wait(self.running(), "time"), max(deadline_ns, self.now_ns))

    def read_clock(self) -> int:
        """Return the time [ns] for a thread that asks for it; the time advances for one that does nothing else."""
        thread = self.current
        if thread is not None:
            thread.reads += 1
            if thread.reads > MAX_READS and not self.is_foreign:
                self.sleep_until(self.now_ns + READING_NS)
        return self.now_ns

    @property
    def is_anyone_ready(self) -> bool:
        """Whether another thread can run at this instant."""
        return bool(self._ready)

    @property
    def is_foreign(self) -> bool:
        """Whether a real thread beside the run asks; the clean-up of objects may run in one."""
        return _real_ident() != self._ident

    def wait_outside(self, condition: Callable[[], bool]) -> None:
        """Wait for a condition in a real thread beside the run."""
        while not condition():
            _real_sleep(_POLL_S)

    def running(self) -> Thread:
        """Return the thread that runs.

        Raises
        ------
        RuntimeError
            Outside of the run's threads.
        """
        if self.current is None:
            raise RuntimeError("only a thread of a lock-step run can wait; this is its scheduler")
        return self.current

    # Switching.

    def run(self) -> None:
        """Run until nothing is left to do, or `stop` is called.

        Raises
        ------
        LockstepError
            When the run cannot go on.
        """
        self._stopped = False
        while (following := self._next()) is not None:
            self._enter(following)
            while (following := self._starting) is not None:
                self._starting = None
                self._enter(following)
            self.current = None
        self._leave_owner()
        if self._error is not None:
            error, self._error = self._error, None
            raise error

    def stop(self, error: BaseException | None = None) -> None:
        """End `run`, with an exception or without; the threads stay where they are."""
        self._stopped = True
        self._error = self._error or error

    def switch_to_next(self, thread: Thread) -> None:
        """Run the next thread that is ready; return when it is the calling one's turn again."""
        loop = asyncio._get_running_loop()
        following = self._next()
        if following is None:
            self.hub.switch()
        elif not following.started:
            # A greenlet counts the depth of recursion from that of the one that starts it: `run` is the shallowest.
            self._starting = following
            self.hub.switch()
        elif following is not thread:
            self._enter(following)
        self.current = thread
        thread.reads = 0
        asyncio._set_running_loop(loop)

    def _enter(self, thread: Thread) -> None:
        if self._owner is not thread.owner:
            self._leave_owner()
            self._owner = thread.owner
            thread.owner.enter()
        self.current = thread
        self.switches += 1
        thread.started = True
        thread.switch()

    def _leave_owner(self) -> None:
        owner, self._owner = self._owner, None
        if owner is not None:
            owner.leave()

    def _next(self) -> Thread | None:
        """Return the next thread that is ready, advancing the time if need be; None when there is none."""
        while not self._stopped:
            if not self._ready:
                if not self._advance():
                    return None
                continue
            thread, wait = self._ready.popleft()
            waiting = thread.waiting
            if thread.ended or (thread.started and (waiting is None or wait not in (None, waiting))):
                continue  # it went on already
            self._count_at_instant(thread)
            return thread
        return None

    def _advance(self) -> bool:
        deadlines = self._deadlines
        while deadlines:
            due, _, wait = heapq.heappop(deadlines)
            if wait.woken or wait.thread.ended or wait.thread.waiting is not wait:
                continue
            if due > self.now_ns:
                self._set_now(due)
            self._ready.append((wait.thread, wait))
            while deadlines and deadlines[0][0] <= due:
                wait = heapq.heappop(deadlines)[2]
                if not wait.woken:
                    self._ready.append((wait.thread, wait))
            return True
        return False

    def _set_now(self, now_ns: int) -> None:
        before, self.now_ns = self.now_ns, now_ns
        self._at_instant = 0
        if self.on_advance is not None:
            self.on_advance(before)

    # Standstills.

    def _count_at_instant(self, thread: Thread) -> None:
        self._at_instant += 1
        if self._at_instant < MAX_SWITCHES - 1000:
            self._busy.clear()
            return
        label = f"{thread.owner.name} ({thread.name})"
        self._busy[label] = self._busy.get(label, 0) + 1
        if self._at_instant >= MAX_SWITCHES:
            busiest = ", ".join(sorted(self._busy, key=lambda name: -self._busy[name])[:5])
            self.stop(LockstepError(f"{self._at()}: threads wake each other without end: {busiest}"))

    def _refuse_deadlock(self, thread: Thread) -> None:
        """Stop the run when a thread waits for a lock whose holder waits, perhaps through others, for this thread."""
        chain = [thread]
        while True:
            waiting = chain[-1].waiting
            holder = None if waiting is None else getattr(waiting.lock, "holder", None)
            if holder is thread:
                break
            if not isinstance(holder, Thread) or holder.ended or holder in chain:
                return
            chain.append(holder)
        lines = [f"{self._at()}: {len(chain)} thread(s) wait for each other for ever"]
        for one, holder in zip(chain, [*chain[1:], thread], strict=True):
            lines.append(
                f"{one.owner.name} ({one.name}) waits for a lock that {holder.owner.name} ({holder.name}) has:"
            )
            lines.append(one.stack() or "".join(traceback.format_stack()))
        self.stop(LockstepError("\n".join(lines)))

    def _at(self) -> str:
        return f"the run cannot go on at {1e-9 * self.now_ns:g} s"
