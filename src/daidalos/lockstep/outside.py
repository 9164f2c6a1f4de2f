"""What follows the real time in a lock-step run: sockets, ``select``, timers of the system; each use is named once.

A thread that waits for a socket or a file hands on like any other. Where nobody else can run at that instant, the
system is asked for a moment of real time, since the peer may be another process; then the stepped time goes on.
"""

from __future__ import annotations

import os
import select
import selectors  # noqa: F401  # it keeps the system's poll and epoll, as subprocess needs them
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from types import FrameType
from typing import Any

from daidalos.lockstep.scheduler import Scheduler

_REAL_WAIT_S = 0.05
"""Real time [s] that a peer in another process gets before the stepped time goes on."""

_MAX_REAL_WAIT_S = 1.0
"""Real time [s] for which a run waits for other processes altogether, counted from when one last answered."""

_POLL_NS = 10_000_000
"""Stepped time [ns] after which a thread looks at its socket again."""

_LIBRARY = os.path.dirname(os.__file__)
_PACKAGE = os.path.join(os.path.dirname(os.path.dirname(__file__)), "")


class Outside:
    """Waits of a run for what is outside of it.

    Parameters
    ----------
    scheduler : Scheduler
    """

    def __init__(self, scheduler: Scheduler) -> None:
        self._scheduler = scheduler
        self._named: set[tuple[str, int]] = set()
        self._select = select.select
        self._real_wait_left_s = _MAX_REAL_WAIT_S

    def install(self) -> None:
        """Replace what waits for sockets and files, and name what only the system's time drives."""
        module: Any = socket.socket
        for name in ("recv", "recv_into", "recvfrom", "recvfrom_into", "recvmsg", "accept"):
            if hasattr(module, name):
                setattr(module, name, self._receiver(getattr(module, name), name))
        selects: Any = select
        selects.select = self._select_in_steps
        for name, unit_s in (("poll", 1e-3), ("epoll", 1.0)):
            if hasattr(select, name):
                setattr(select, name, self._maker_of_polls(getattr(select, name), f"select.{name}", unit_s))
        processes: Any = subprocess.Popen
        processes.__init__ = self._named_only(processes.__init__, "subprocess.Popen", is_ours_quiet=True)
        os.system = self._named_only(os.system, "os.system")
        for name in ("setitimer", "alarm"):
            if hasattr(signal, name):
                setattr(signal, name, self._named_only(getattr(signal, name), f"signal.{name}"))
        clocks: Any = time
        if hasattr(time, "clock_gettime"):
            clocks.clock_gettime = lambda clock: time.time() if clock == time.CLOCK_REALTIME else time.monotonic()
            clocks.clock_gettime_ns = lambda clock: (
                time.time_ns() if clock == time.CLOCK_REALTIME else time.monotonic_ns()
            )

    def _receiver(self, receive: Callable[..., Any], name: str) -> Callable[..., Any]:
        def wait_and_receive(self_: Any, *args: Any, **kwargs: Any) -> Any:
            limit = self_.gettimeout()
            if limit != 0.0 and not self._select_for([self_], [], [], limit, f"socket.{name}")[0]:
                raise TimeoutError("timed out")
            return receive(self_, *args, **kwargs)

        wait_and_receive.__name__ = name
        return wait_and_receive

    def _select_in_steps(self, read: Any, write: Any, failed: Any, timeout: float | None = None) -> Any:
        return self._select_for(read, write, failed, timeout, "select.select")

    def _select_for(self, read: Any, write: Any, failed: Any, limit_s: float | None, what: str) -> Any:
        return self.wait(lambda moment_s: self._select(read, write, failed, moment_s), limit_s, what)

    def _maker_of_polls(self, make: Callable[..., Any], what: str, unit_s: float) -> Callable[..., Any]:
        """Return what makes objects of ``select.poll`` or ``epoll``, whose times have a unit [s]."""

        def call(*args: Any, **kwargs: Any) -> Any:
            return _SteppedPoll(self, make(*args, **kwargs), what, unit_s)

        return call

    def wait(self, look: Callable[[float], Any], limit_s: float | None, what: str) -> Any:
        """Wait as `select.select` does, for at most so much stepped time.

        Parameters
        ----------
        look : callable
            Of a real time [s] that it may wait; it returns a sequence, with something true in it where a wait ends.
        limit_s : float or None
        what : str
            Name of what waits.
        """
        scheduler = self._scheduler
        found = look(0.0)
        if any(found) or scheduler.current is None or scheduler.is_foreign or limit_s == 0:
            return found
        self._name(what)
        deadline = None if limit_s is None else scheduler.now_ns + max(round(1e9 * limit_s), 1)
        while deadline is None or scheduler.now_ns < deadline:
            scheduler.sleep_until(scheduler.now_ns)  # whoever can run at this instant may be the peer
            found = look(0.0)
            if not any(found) and not scheduler.is_anyone_ready:
                found = self._wait_really(look)
            if any(found):
                return found
            following = scheduler.now_ns + _POLL_NS
            scheduler.sleep_until(following if deadline is None else min(following, deadline))
        return look(0.0)

    def _wait_really(self, look: Callable[[float], Any]) -> Any:
        """Give other processes a moment."""
        moment = min(_REAL_WAIT_S, max(self._real_wait_left_s, 0.0))
        found = look(moment)
        self._real_wait_left_s = _MAX_REAL_WAIT_S if any(found) else self._real_wait_left_s - moment
        return found

    def _named_only(
        self, function: Callable[..., Any], what: str, *, is_ours_quiet: bool = False
    ) -> Callable[..., Any]:
        def call(*args: Any, **kwargs: Any) -> Any:
            self._name(what, is_ours_quiet=is_ours_quiet)
            return function(*args, **kwargs)

        return call

    def _name(self, what: str, *, is_ours_quiet: bool = False) -> None:
        """Name the line of a program that uses something outside of the run, once."""
        frame = _first_own_frame(sys._getframe(1))
        if is_ours_quiet and frame is not None and _is_ours(frame.f_code.co_filename):
            return
        if frame is None or (where := (frame.f_code.co_filename, frame.f_lineno)) in self._named:
            return
        self._named.add(where)
        thread = self._scheduler.current
        program = "" if thread is None else f" of {thread.owner.name}"
        line = f"{where[0]}:{where[1]}: {what}{program} follows the real time; from here on runs may differ"
        os.write(2, f"[lockstep] {line}\n".encode())


def _first_own_frame(frame: FrameType | None) -> FrameType | None:
    """Return the first frame outside of this module and of Python's own library; None where there is none."""
    while frame is not None:
        file = frame.f_code.co_filename
        if file != __file__ and (not file.startswith((_LIBRARY, "<frozen ")) or "site-packages" in file):
            return frame
        frame = frame.f_back
    return None


def _is_ours(file: str) -> bool:
    """Return whether a file is of this package or of the launch system, which start what a run needs."""
    launch = getattr(sys.modules.get("launch"), "__file__", None) or file
    return file.startswith(_PACKAGE) or (launch != file and file.startswith(os.path.join(os.path.dirname(launch), "")))


class _SteppedPoll:
    """Object of ``select.poll`` or ``epoll`` that waits for the stepped time."""

    def __init__(self, outside: Outside, real: Any, what: str, unit_s: float) -> None:
        self._outside, self._real = outside, real
        self._what, self._unit_s = what, unit_s

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real, name)

    def __enter__(self) -> _SteppedPoll:
        return self

    def __exit__(self, *error: object) -> None:
        self._real.close()

    def poll(self, timeout: float | None = None, *count: int) -> Any:
        """Return what is ready, waiting for at most so much time in the unit of the original."""
        limit_s = None if timeout is None or timeout < 0 else self._unit_s * timeout
        return self._outside.wait(
            lambda moment_s: self._real.poll(moment_s / self._unit_s, *count), limit_s, self._what
        )
