"""Implementation of timers on any clock."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from rclpy.clock_type import ClockType
from rclpy.impl.clock import ClockHandle
from rclpy.impl.errors import TimerCancelledError
from rclpy.impl.handle import Destroyable
from rclpy.impl.ready import ReadyNotifier

Schedule = Callable[[int, "TimerHandle"], None]
"""Asks for `on_due` when ``time.monotonic_ns()`` reaches a deadline."""


class TimerHandle(ReadyNotifier, Destroyable):
    """A timer with a period in nanoseconds of its clock.

    Attributes
    ----------
    on_due
        Called when a call is due; any thread.
    version
        Changes whenever what was scheduled before is void.
    """

    def __init__(self, clock: ClockHandle, period_ns: int, on_due: Callable[[], None], autostart: bool = True) -> None:
        super().__init__()
        self.clock = clock
        self.announce_to(on_due)
        self.version = 0
        self._period = period_ns
        self._schedule: Schedule | None = None
        self._canceled = not autostart
        self._lock = threading.Lock()
        self._last_call = clock.now_ns()
        self._next_call = self._last_call + period_ns

    def _wire(self, call: Callable[[], None]) -> None:
        self.on_due = call

    # The clock's and the executor's side.

    def attach(self, schedule: Schedule | None) -> None:
        """Set the executor that waits for wall time, and schedule the next call."""
        self._schedule = schedule
        self.reschedule()

    def reschedule(self) -> None:
        """Schedule the next call anew, in place of the one before."""
        with self._lock:
            self.version += 1
            if self._canceled or self.is_destroyed:
                return
            deadline, schedule = self._next_call, self._schedule
        if self.clock.overridden:
            self.clock.schedule(deadline, self)
        elif schedule:
            if self.clock.clock_type is not ClockType.STEADY_TIME:
                deadline += time.monotonic_ns() - self.clock.now_ns()
            schedule(deadline, self)

    def on_backward_jump(self, now_ns: int) -> None:
        """Restart the period at the new time: the old deadline may be far away."""
        with self._lock:
            self._last_call = now_ns
            self._next_call = now_ns + self._period
        self.reschedule()

    # The timer's own.

    def call_timer(self) -> tuple[int, int]:
        """Record a call, and return when it was due and when it was made. Periods that were missed are skipped.

        Raises
        ------
        TimerCancelledError
            When the timer is cancelled.
        """
        called = self._call(early=True)
        if called is None:
            raise TimerCancelledError("Timer has been canceled")
        return called

    def call_timer_with_info(self) -> dict[str, int]:
        """Record a call as `call_timer` does; return its times by name [ns].

        Raises
        ------
        TimerCancelledError
            When the timer is cancelled.
        """
        expected, actual = self.call_timer()
        return {"expected_call_time": expected, "actual_call_time": actual}

    def call_if_due(self) -> tuple[int, int] | None:
        """Record a call as `call_timer` does; return None when none is due or the timer is cancelled or destroyed."""
        return self._call(early=False)

    def _call(self, *, early: bool) -> tuple[int, int] | None:
        clock = self.clock
        with self._lock:
            now, due = clock.now_ns(), self._next_call
            if self._canceled or (not early and (now < due or self._please_destroy)):
                return None
            following, period = due + self._period, self._period
            if following < now:
                following = following - (following - now) // period * period if period else now
            self._last_call, self._next_call = now, following
            self.version += 1
            if self._please_destroy:
                return due, now
        schedule = self._schedule
        if clock.overridden:
            clock.schedule(following, self)
        elif schedule is not None:
            if clock.clock_type is not ClockType.STEADY_TIME:
                following += time.monotonic_ns() - now
            schedule(following, self)
        return due, now

    def is_timer_ready(self) -> bool:
        """Return whether a call is due."""
        return not self._canceled and self.clock.now_ns() >= self._next_call

    def is_timer_canceled(self) -> bool:
        """Return whether the timer is cancelled."""
        return self._canceled

    def cancel_timer(self) -> None:
        """Stop until `reset_timer`."""
        with self._lock:
            self._canceled = True
            self.version += 1

    def reset_timer(self) -> None:
        """Start, or start anew: the next call is a full period away."""
        with self._lock:
            self._canceled = False
            self._next_call = self.clock.now_ns() + self._period
        self.reschedule()

    def time_until_next_call(self) -> int | None:
        """Return how long until the next call, in nanoseconds (negative when it is late); None if cancelled."""
        return None if self._canceled else self._next_call - self.clock.now_ns()

    def time_since_last_call(self) -> int:
        """Return how long ago the last call was, in nanoseconds."""
        return self.clock.now_ns() - self._last_call

    def get_timer_period(self) -> int:
        """Return the period in nanoseconds."""
        return self._period

    def change_timer_period(self, period_ns: int) -> None:
        """Set the period from the next call on, in nanoseconds."""
        with self._lock:
            self._period = period_ns

    def _destroy(self) -> None:
        self.version += 1
        self._schedule = None
