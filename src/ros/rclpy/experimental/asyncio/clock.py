"""Clocks of nodes for asyncio."""

from __future__ import annotations

import asyncio
from typing import Any

from rclpy.clock import JumpThreshold, ROSClock, TimeJump
from rclpy.exceptions import TimeSourceChangedError
from rclpy.experimental.asyncio.loops import post


class AsyncClock(ROSClock):
    """ROS time that a coroutine can sleep by."""

    _sleepers: set[_Sleeper] | None

    def __new__(cls) -> Any:
        """Create a clock."""
        self = super().__new__(cls)
        self._sleepers = set()
        return self

    async def sleep(self, seconds: float) -> None:
        """Sleep for a span of the clock's time.

        Raises
        ------
        TimeSourceChangedError
            When a simulator begins or ceases to give the time meanwhile.
        asyncio.CancelledError
            When the node is destroyed meanwhile.
        RuntimeError
            When the node was destroyed before.
        """
        if self._sleepers is None:
            raise RuntimeError("the clock's node was destroyed")
        if seconds <= 0:
            await asyncio.sleep(0)
            return
        sleeper = _Sleeper(self, self.handle.now_ns() + int(seconds * 1e9))
        self._sleepers.add(sleeper)
        threshold = JumpThreshold(min_forward=None, min_backward=None, on_clock_change=True)
        try:
            with self.create_jump_callback(threshold, post_callback=sleeper.on_change):
                sleeper.start()
                await sleeper.woken
        finally:
            sleeper.end()
            if self._sleepers is not None:
                self._sleepers.discard(sleeper)

    def close(self) -> None:
        """Cancel all sleep, for good."""
        sleepers, self._sleepers = self._sleepers or set(), None
        for sleeper in sleepers:
            sleeper.woken.cancel()


class _Sleeper:
    """One sleep; for an overridden clock it stands in for a timer, which the clock tells when it is due."""

    def __init__(self, clock: AsyncClock, until_ns: int) -> None:
        self._handle = clock.handle
        self._until = until_ns
        self._loop = asyncio.get_running_loop()
        self.woken: asyncio.Future[None] = self._loop.create_future()
        self._alarm: asyncio.TimerHandle | None = None
        self.version = 0

    def start(self) -> None:
        """Start waiting for the time."""
        if self._handle.overridden:
            self._handle.schedule(self._until, self)  # type: ignore[arg-type]
        else:
            self._on_alarm()

    def end(self) -> None:
        """Wait no more."""
        self.version += 1
        if self._alarm is not None:
            self._alarm.cancel()

    def _on_alarm(self) -> None:
        left = self._until - self._handle.now_ns()
        if left > 0:
            self._alarm = self._loop.call_later(left / 1e9, self._on_alarm)
        else:
            self._wake()

    def _wake(self, error: Exception | None = None) -> None:
        if self.woken.done():
            return
        if error is None:
            self.woken.set_result(None)
        else:
            self.woken.set_exception(error)

    # What a clock calls, on whatever thread.

    def on_due(self) -> None:
        """Wake the sleeper: the time has come."""
        post(self._loop, self._wake)

    def on_backward_jump(self, now_ns: int) -> None:
        """Wait on: the time is farther away."""
        self._handle.schedule(self._until, self)  # type: ignore[arg-type]

    reschedule = on_due

    def on_change(self, jump: TimeJump) -> None:
        """Wake the sleeper with an error: the source of the time changed."""
        post(self._loop, self._wake, TimeSourceChangedError())
