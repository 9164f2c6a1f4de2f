"""Clocks: system time, steady time, and ROS time, which a simulator may override."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypedDict

from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.exceptions import NotInitializedException
from rclpy.impl.clock import ClockChange, ClockHandle
from rclpy.time import Time

if TYPE_CHECKING:
    from rclpy.context import Context

__all__ = [
    "Clock",
    "ClockChange",
    "ClockHandle",
    "ClockType",
    "JumpHandle",
    "JumpThreshold",
    "ROSClock",
    "TimeJump",
    "TimeJumpDictionary",
]


class JumpThreshold:
    """Time jumps of which a callback is notified.

    Parameters
    ----------
    min_forward
        The smallest jump forward, a positive duration, or None for no jump forward.
    min_backward
        The smallest jump backward, a negative duration, or None for no jump backward.
    on_clock_change
        Whether the callback is called when the override of ROS time is switched on or off.

    Raises
    ------
    ValueError
        For a duration of the wrong sign, or when the callback could never be called.
    """

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward = min_forward
        self.min_backward = min_backward
        self.on_clock_change = on_clock_change


class TimeJump:
    """A jump of a clock: what changed, and by how much."""

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, (ClockChange, type(None))):
            raise TypeError("clock_change must be a ClockChange")
        self._clock_change = clock_change
        self._delta = delta

    @property
    def clock_change(self) -> ClockChange:
        """What happened to the source of time."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """By how much the time changed."""
        return self._delta


class TimeJumpDictionary(TypedDict):
    """A time jump as plain data."""

    clock_change: ClockChange
    delta: int


class JumpHandle:
    """A registered pair of jump callbacks; `unregister`, or leaving its ``with`` block, ends it."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self._clock: Clock | None = clock
        self._pre = pre_callback
        self._post = post_callback
        forward = threshold.min_forward.nanoseconds if threshold.min_forward else 0
        backward = threshold.min_backward.nanoseconds if threshold.min_backward else 0
        clock.handle.add_clock_callback(self, threshold.on_clock_change, forward, backward)

    def call_pre(self) -> None:
        """Call the callback before a jump."""
        if self._pre:
            self._pre()

    def call_post(self, change: ClockChange, delta_ns: int) -> None:
        """Call the callback after a jump."""
        if self._post:
            self._post(TimeJump(change, Duration(nanoseconds=delta_ns)))

    def unregister(self) -> None:
        """Unregister the callbacks."""
        if self._clock is not None:
            self._clock.handle.remove_clock_callback(self)
            self._clock = None

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *exception: object) -> None:
        self.unregister()


class Clock:
    """A clock of one kind. ``Clock(clock_type=ClockType.ROS_TIME)`` is a `ROSClock`."""

    _type: ClockType
    _handle: ClockHandle

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Any:
        """Create a clock of the kind.

        Raises
        ------
        TypeError
            When `clock_type` is no `ClockType`.
        """
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        is_ros = clock_type is ClockType.ROS_TIME
        self = super().__new__(ROSClock if is_ros and not issubclass(cls, ROSClock) else cls)
        self._handle = ClockHandle(clock_type)
        self._type = clock_type
        return self

    @property
    def clock_type(self) -> ClockType:
        """The kind."""
        return self._type

    @property
    def handle(self) -> ClockHandle:
        """What is behind the clock."""
        return self._handle

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._type.name})"

    def now(self) -> Time:
        """Return the clock's time."""
        return Time(nanoseconds=self._handle.now_ns(), clock_type=self._type)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Register callbacks for time jumps.

        Raises
        ------
        ValueError
            When there is nothing to call.
        """
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until the clock shows a time.

        Returns
        -------
        bool
            True when it does; False when the context was shut down or the source of time changed before.

        Raises
        ------
        ValueError
            For a time of another clock type.
        NotInitializedException
            When the context is not initialized.
        """
        from rclpy.utilities import get_default_context

        context = context or get_default_context()
        if not context.ok():
            raise NotInitializedException()
        if until.clock_type != self._type:
            raise ValueError("until's clock type does not match this clock's type")
        handle = self._handle
        overridden = handle.overridden
        changed = handle.changed

        def wake() -> None:
            with changed:
                changed.notify_all()

        context.on_shutdown(wake)
        with changed:
            while context.ok() and handle.overridden == overridden:
                left = until.nanoseconds - handle.now_ns()
                if left <= 0:
                    return True
                changed.wait(None if overridden else min(left / 1e9, 3600.0))
        return until.nanoseconds <= handle.now_ns() and handle.overridden == overridden

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep for a duration of the clock; see `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)


class ROSClock(Clock):
    """ROS time: the system's time, or a simulator's."""

    def __new__(cls) -> Any:
        """Create a clock."""
        return Clock.__new__(cls, clock_type=ClockType.ROS_TIME)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the time is a simulator's."""
        return self._handle.get_ros_time_override_is_enabled()

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        self._handle.set_ros_time_override_is_enabled(enabled)

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time that the clock shows.

        Raises
        ------
        TypeError
            When `time` is no `Time`.
        """
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        self._handle.set_ros_time_override(time)
