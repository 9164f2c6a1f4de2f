"""Timers and rates."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, Self

from rclpy.callback_groups import CallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.exceptions import ROSInterruptException
from rclpy.impl.errors import InvalidHandle
from rclpy.impl.ready import ReadyHook
from rclpy.impl.timer import TimerHandle
from rclpy.time import Time
from rclpy.utilities import get_default_context


class TimerInfo:
    """Expected and actual time of a timer's call."""

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        self._expected = Time(nanoseconds=max(expected_call_time, 0), clock_type=clock_type)
        self._actual = Time(nanoseconds=actual_call_time, clock_type=clock_type)

    @property
    def expected_call_time(self) -> Time:
        """When it was due."""
        return self._expected

    @property
    def actual_call_time(self) -> Time:
        """When it was made."""
        return self._actual


class Timer:
    """Timer that calls a function periodically; made by `Node.create_timer`."""

    def __init__(
        self,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        self._context = context or get_default_context()
        self._clock = clock
        self._rcl_hook = ReadyHook(self)
        self._rcl_node: Any = None
        self.__timer = TimerHandle(clock.handle, int(timer_period_ns), self._rcl_hook, autostart)
        self.timer_period_ns = timer_period_ns
        self.callback = callback
        self.callback_group = callback_group

    @property
    def handle(self) -> TimerHandle:
        """What is behind the timer."""
        return self.__timer

    def destroy(self) -> None:
        """Destroy the handle; use `Node.destroy_timer` instead."""
        self.__timer.destroy_when_not_in_use()

    @property
    def clock(self) -> Clock:
        """The clock that the period is counted on."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds of the clock."""
        with self.__timer:
            return self.__timer.get_timer_period()

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        with self.__timer:
            self.__timer.change_timer_period(int(value))

    @property
    def callback(self) -> Callable[..., Any] | None:
        """What is called; with a `TimerInfo` when it takes an argument annotated so."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., Any] | None) -> None:
        self._callback = value
        self._with_info = _takes_info(value)

    def is_ready(self) -> bool:
        """Return whether a call is due."""
        with self.__timer:
            return self.__timer.is_timer_ready()

    def is_canceled(self) -> bool:
        """Return whether the timer is cancelled."""
        with self.__timer:
            return self.__timer.is_timer_canceled()

    def cancel(self) -> None:
        """Cancel all calls until `reset`."""
        with self.__timer:
            self.__timer.cancel_timer()

    def reset(self) -> None:
        """Start, or start anew: the next call is a full period away."""
        with self.__timer:
            self.__timer.reset_timer()

    def time_since_last_call(self) -> int:
        """Return how long ago the last call was, in nanoseconds."""
        with self.__timer:
            return self.__timer.time_since_last_call()

    def time_until_next_call(self) -> int | None:
        """Return how long until the next call, in nanoseconds (negative when late); None if cancelled."""
        with self.__timer:
            return self.__timer.time_until_next_call()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        called = self.__timer.call_if_due()
        if called is None or self._callback is None:
            return None
        if self._with_info:
            expected, actual = called
            info = TimerInfo(expected_call_time=expected, actual_call_time=actual, clock_type=self._clock.clock_type)
            return self._callback, (info,)
        return self._callback, ()

    def _rcl_has_more(self) -> bool:
        return False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.destroy()


def _takes_info(callback: Callable[..., Any] | None) -> bool:
    """Return whether a callback has a parameter annotated as `TimerInfo`."""
    try:
        parameters = inspect.signature(callback).parameters if callback is not None else {}
    except (TypeError, ValueError):
        return False  # a built-in function
    return any(_names_info(one.annotation) for one in parameters.values())


def _names_info(annotation: Any) -> bool:
    return annotation is TimerInfo or (isinstance(annotation, str) and annotation.split(".")[-1] == "TimerInfo")


class Rate:
    """Timer for a loop at a fixed rate; made by `Node.create_rate`. It needs no executor."""

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._clock = timer.clock
        self._context = context
        self._timer = timer
        self._is_shutdown = False
        self._is_destroyed = False
        self._next = timer.clock.now().nanoseconds
        context.on_shutdown(self._shutdown)

    def _shutdown(self) -> None:
        self._is_shutdown = True
        self.destroy()

    def destroy(self) -> None:
        """Destroy the rate; a sleeper wakes with an exception."""
        self._is_destroyed = True
        changed = self._clock.handle.changed
        with changed:
            changed.notify_all()

    def _presleep(self) -> None:
        if self._is_shutdown or not self._context.ok():
            raise ROSInterruptException()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if not self._timer.handle.is_destroyed:
            return
        self.destroy()
        raise InvalidHandle("the rate's timer was destroyed")

    def sleep(self) -> None:
        """Sleep until the next multiple of the period.

        Raises
        ------
        ROSInterruptException
            When the context is shut down.
        RuntimeError
            When the rate was destroyed.
        """
        self._presleep()
        period = self._timer.timer_period_ns
        now = self._clock.now().nanoseconds
        due = self._next + period
        if due <= now:  # late: go on at once, in the same rhythm
            self._next = due + (now - due) // period * period
            return
        self._next = min(due, now + period)  # the clock may have stepped backward
        handle = self._clock.handle
        with handle.changed:
            while not self._is_destroyed and self._context.ok():
                left = self._next - handle.now_ns()
                if left <= 0 or left > period:
                    break
                handle.changed.wait(None if handle.overridden else left / 1e9)
        self._presleep()
