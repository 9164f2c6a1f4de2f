"""A lock-step run of a program and of those that it launches."""

from __future__ import annotations

import gc
import os
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from typing import Any

from daidalos import lockstep
from daidalos.lockstep import patching
from daidalos.lockstep.programs import Program
from daidalos.lockstep.scheduler import Owner, Scheduler
from daidalos.lockstep.standstill import describe

_COLLECT_NS = 10_000_000_000
"""Simulated time [ns] between collections of garbage, which must not depend on anything else."""

_STUCK_S = 20.0
"""Real time [s] after which a callback that does not hand on is named, and again after each doubling."""


class Run:
    """A run: the scheduler, its programs and what watches over them.

    Parameters
    ----------
    seed : int
        Programs get seeds of their own from it, by their order.
    """

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed
        self.scheduler = Scheduler()
        self.programs: list[Program] = []
        self._outside = Owner()
        self._randomness = patching.Randomness(seed)
        self._handlers: dict[int, Any] = {}
        self._main_thread = threading.main_thread()
        self._next_collection = _COLLECT_NS
        self._is_frozen = False
        self._interrupts = 0
        self._ident = patching.real_thread_ident()
        self._begun_s = patching.real_monotonic()
        lockstep.current_run = self
        gc.disable()
        self.scheduler.on_advance = self._on_advance
        patching.install(
            self.scheduler,
            patching.Hooks(
                owner=self._owner,
                randomness=lambda: self._present(lambda program: program.randomness, self._randomness),
                main_thread=lambda: self._present(lambda program: program.main_thread, self._main_thread),
                handlers=lambda: self._present(lambda program: program.handlers, self._handlers),
                send_signal=self._send_signal,
            ),
        )
        self._is_watched = False

    def reseed(self, seed: int) -> None:
        """Set another seed; to be called before the first program is created."""
        self.seed = seed
        self._randomness = patching.Randomness(seed)

    def create(self, body: Callable[[], Any], argv: Sequence[str], **options: Any) -> Program:
        """Return a new program; see `Program`."""
        seed = self.seed * 1_000_003 + len(self.programs)
        program = Program(self.scheduler, body, argv, seed, **options)
        self.programs.append(program)
        return program

    @property
    def elapsed_s(self) -> tuple[float, float]:
        """Simulated and real time [s] since the start of the run."""
        return 1e-9 * self.scheduler.now_ns, patching.real_monotonic() - self._begun_s

    def go(self) -> None:
        """Run until nothing is left to do.

        Raises
        ------
        LockstepError
            When the run cannot go on.
        """
        if not self._is_watched:
            self._is_watched = True
            patching.start_real_thread(self._watch, ())
        streams = sys.stdout, sys.stderr
        try:
            self.scheduler.run()
        finally:
            sys.stdout, sys.stderr = streams

    def _owner(self) -> Owner:
        thread = self.scheduler.current
        return self._outside if thread is None else thread.owner

    def _present(self, of: Callable[[Program], Any], outside: Any) -> Any:
        owner = self._owner()
        return of(owner) if isinstance(owner, Program) else outside

    def _send_signal(self, number: int) -> None:
        """Send a signal to the present program, or a real one, which comes as a negative number, to the first one."""
        if number < 0:
            self._interrupts += 1
            if self._interrupts > 1 or not self.programs:
                from daidalos.common.temporary_files import delete_temporary_files

                delete_temporary_files()
                os._exit(128 - number)
            self.programs[0].send_signal(-number)
            return
        owner = self._owner()
        if isinstance(owner, Program):
            owner.send_signal(number)

    def _on_advance(self, before_ns: int) -> None:
        if self.scheduler.now_ns >= self._next_collection:
            self._next_collection = self.scheduler.now_ns + _COLLECT_NS
            # What is there at first stays: modules, nodes, parameters. To look through it takes a quarter of a second.
            if self._is_frozen:
                gc.collect()
            else:
                self._is_frozen = True
                gc.collect()
                gc.freeze()

    def _watch(self) -> None:
        """Name the callback that does not hand on; in a real thread."""
        seen, since, limit = -1, patching.real_monotonic(), _STUCK_S
        while True:
            patching.real_sleep(0.5)
            switches = self.scheduler.switches
            now = patching.real_monotonic()
            if switches != seen:
                seen, since, limit = switches, now, _STUCK_S
            elif now - since >= limit:
                limit *= 2.0
                thread = self.scheduler.current
                name = "the scheduler" if thread is None else f"{thread.owner.name} ({thread.name})"
                frame = sys._current_frames().get(self._ident)
                stack = "".join(traceback.format_stack(frame)) if frame is not None else ""
                os.write(2, f"[lockstep] {name} has been running for {now - since:.0f} s:\n{stack}".encode())


def exit_status(run: Run, program: Program) -> int:
    """Return the status that a process should end with after a run whose first program this is."""
    if program.status is None:
        waiting = describe(list(run.scheduler.threads.values()))
        sys.stderr.write(f"[lockstep] nothing is left to happen; every thread waits:\n{waiting}\n")
        return 1
    return program.status if program.status >= 0 else 128 - program.status
