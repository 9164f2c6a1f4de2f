"""Implementation of clocks: time source, time jumps and timers."""

from __future__ import annotations

import heapq
import itertools
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Protocol

from rclpy.clock_type import ClockType
from rclpy.impl.handle import Destroyable

_SOURCES: dict[ClockType, Callable[[], int]] = {
    ClockType.ROS_TIME: time.time_ns,
    ClockType.SYSTEM_TIME: time.time_ns,
    ClockType.STEADY_TIME: time.monotonic_ns,
}


class ClockChange(IntEnum):
    """Change of a clock's time source."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


@dataclass(frozen=True)
class _JumpCallback:
    owner: Any
    on_clock_change: bool
    min_forward_ns: int
    min_backward_ns: int

    def wants(self, change: ClockChange, delta_ns: int) -> bool:
        if change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        forward = 0 < self.min_forward_ns <= delta_ns
        return forward or 0 > self.min_backward_ns >= delta_ns


class ClockTimer(Protocol):
    """What a clock needs of the timers that follow it."""

    on_due: Callable[[], None]
    version: int

    def reschedule(self) -> None:
        """Schedule the next call anew, in place of the one before."""

    def on_backward_jump(self, now_ns: int) -> None:
        """Restart the period at the new time [ns]."""


class ClockHandle(Destroyable):
    """A clock. One of type ROS_TIME can be overridden: then it shows the time that was set, not the system's."""

    def __init__(self, clock_type: ClockType) -> None:
        super().__init__()
        self.clock_type = clock_type
        self._source = _SOURCES[clock_type]
        self._override: int | None = None
        self._last_override = 0
        self._jumps: list[_JumpCallback] = []
        self._forward_ns, self._backward_ns = math.inf, -math.inf  # the smallest jumps that a callback is told of
        self._timers: list[tuple[int, int, int, ClockTimer]] = []
        self._count = itertools.count().__next__
        self.changed = threading.Condition(threading.RLock())

    def now_ns(self) -> int:
        """Return the clock's time in nanoseconds."""
        override = self._override
        return self._source() if override is None else override

    @property
    def overridden(self) -> bool:
        """Whether the clock shows a time that was set."""
        return self._override is not None

    def get_now(self) -> Any:
        """Return the clock's time as rclpy's compiled part does."""
        from rclpy.time import Time

        return Time(nanoseconds=self.now_ns(), clock_type=self.clock_type)

    def get_ros_time_override_is_enabled(self) -> bool:
        """Return whether the clock is overridden."""
        return self.overridden

    def set_ros_time_override_is_enabled(self, enabled: bool) -> None:
        """Switch the override of the clock's time on or off."""
        with self.changed:
            if enabled == self.overridden:
                return
            before = self.now_ns()
            change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
            self._jump(change, before, self._last_override if enabled else None)
            waiting, self._timers = self._timers, []
        for *_, timer in waiting:
            timer.reschedule()

    def set_ros_time_override(self, time_point: Any) -> None:
        """Set the time that the clock shows: a `Time` or nanoseconds."""
        self.set_override_ns(getattr(time_point, "nanoseconds", time_point))

    def set_override_ns(self, now_ns: int) -> None:
        """Set the time that the clock shows; due timers become ready."""
        with self.changed:
            self._last_override = now_ns
            if self._override is None:
                return
            before = self._override
            if not self._backward_ns < now_ns - before < self._forward_ns:
                self._jump(ClockChange.ROS_TIME_NO_CHANGE, before, now_ns)
            else:
                self._override = now_ns
                self.changed.notify_all()
            if now_ns < before:
                waiting, self._timers = self._timers, []
                due = []
            else:
                waiting, due = [], self._pop_due(now_ns)
        for *_, timer in waiting:
            timer.on_backward_jump(now_ns)
        for timer in due:
            timer.on_due()

    def _jump(self, change: ClockChange, before: int, override: int | None) -> None:
        after = self._source() if override is None else override
        affected = [jump for jump in self._jumps if jump.wants(change, after - before)]
        for jump in affected:
            jump.owner.call_pre()
        self._override = override
        self.changed.notify_all()
        for jump in affected:
            jump.owner.call_post(change, after - before)

    def _pop_due(self, now_ns: int) -> list[ClockTimer]:
        due = []
        while self._timers and self._timers[0][0] <= now_ns:
            _, _, version, timer = heapq.heappop(self._timers)
            if timer.version == version:
                due.append(timer)
        return due

    def schedule(self, deadline_ns: int, timer: ClockTimer) -> None:
        """Call `timer.on_due` when the overridden clock reaches `deadline_ns`."""
        with self.changed:
            if self._override is not None and deadline_ns > self._override:
                heapq.heappush(self._timers, (deadline_ns, self._count(), timer.version, timer))
                return
        timer.on_due()

    def add_clock_callback(
        self, pyjump_handle: Any, on_clock_change: bool, min_forward: int, min_backward: int
    ) -> None:
        """Call the handle's `call_pre` and `call_post` at jumps over these thresholds (0: never)."""
        with self.changed:
            self._set_jumps([*self._jumps, _JumpCallback(pyjump_handle, on_clock_change, min_forward, min_backward)])

    def remove_clock_callback(self, pyjump_handle: Any) -> None:
        """Remove a handle that `add_clock_callback` added."""
        with self.changed:
            self._set_jumps([jump for jump in self._jumps if jump.owner is not pyjump_handle])

    def _set_jumps(self, jumps: list[_JumpCallback]) -> None:
        self._jumps = jumps
        forward = (jump.min_forward_ns for jump in jumps if jump.min_forward_ns > 0)
        backward = (jump.min_backward_ns for jump in jumps if jump.min_backward_ns < 0)
        self._forward_ns, self._backward_ns = min(forward, default=math.inf), max(backward, default=-math.inf)
