"""The buffer that nodes use: it waits for transforms, follows the node's clock and transforms messages."""

from __future__ import annotations

import threading
import time as system_time
import weakref
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.clock import Clock, JumpHandle, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.timer import TimerHandle
from rclpy.task import Future
from rclpy.utilities import get_default_context
from tf2_py import BufferCore, TransformException
from tf2_py._times import duration_ns

from .buffer_interface import NO_WAIT, BufferInterface

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.node import Node
    from rclpy.time import Time


_ORPHANS: deque[JumpHandle] = deque()
"""What buffers that are no more had registered with a clock."""


class Buffer(BufferCore, BufferInterface):
    """Buffer of transforms, which computes the transform between two frames, now or in the past.

    Nothing polls: who waits is woken by the next transform, by the clock or by the shutdown. Time-outs are of
    the node's clock, so under simulated time they last as long as the simulator says.

    Parameters
    ----------
    cache_time
        How long transforms are remembered, 10 s by default.
    node
        Whose clock to follow: when it jumps back, the buffer is cleared. The node also gets a service
        ``tf2_frames`` that tells the tree of frames. Without a node, that of the first `TransformListener` is
        followed.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._node: weakref.ref[Node] | None = None
        self._context = get_default_context()
        if node is None:
            self._follow_clock(Clock())
            return
        from tf2_msgs.srv import FrameGraph

        self.srv = node.create_service(FrameGraph, "tf2_frames", self._notify_frames)
        self.follow(node)

    def follow(self, node: Node) -> None:
        """Follow a node's clock, unless the buffer follows one already."""
        if self._node is not None:
            return
        self._node = weakref.ref(node)
        self._context = node.context
        self._follow_clock(node.get_clock())

    def _follow_clock(self, clock: Clock) -> None:
        self.clock = clock
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True)
        weak_self = weakref.ref(self)

        def on_jump(jump: TimeJump) -> None:
            buffer = weak_self()
            if buffer is not None and buffer.clock is clock:
                buffer.time_jump_callback(jump)

        while _ORPHANS:
            _ORPHANS.popleft().unregister()
        # A buffer must not live as long as the node's clock, nor take the clock's lock when it is collected.
        self.jump_handle = clock.create_jump_callback(threshold, post_callback=on_jump)
        weakref.finalize(self, _ORPHANS.append, self.jump_handle).atexit = False

    def _notify_frames(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        """Clear the buffer: what it holds belongs to another time."""
        if self._getFrameStrings():
            from rclpy.logging import get_logger

            get_logger("tf2_buffer").warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    # Looking transforms up.

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """Return the transform that takes coordinates in the source frame to the target frame.

        It may wait in any callback of any executor: a `TransformListener` needs none to receive.

        Parameters
        ----------
        target_frame, source_frame
            Names.
        time
            When; zero means the newest time at which it is known.
        timeout
            How long to wait for it.

        Raises
        ------
        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException
            When it is not known in time.
        """
        self._wait(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """Return the transform from the source frame at one time to the target frame at another.

        Parameters
        ----------
        fixed_frame
            The frame that does not move between the two times.
        target_frame, target_time, source_frame, source_time, timeout
            As in `lookup_transform`.
        """
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lambda: self.can_transform_full_core(*asked), timeout)
        return self.lookup_transform_full_core(*asked)

    def can_transform(  # type: ignore[override]
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Return whether `lookup_transform` would find the transform.

        Returns
        -------
        bool, or (bool, str)
            With `return_debug_tuple`, also why not.
        """
        result = self._wait(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return result if return_debug_tuple else result[0]

    def can_transform_full(  # type: ignore[override]
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Return whether `lookup_transform_full` would find the transform; see `can_transform`."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        result = self._wait(lambda: self.can_transform_full_core(*asked), timeout)
        return result if return_debug_tuple else result[0]

    def _wait(self, attempt: Callable[[], tuple[bool, str]], timeout: Any) -> tuple[bool, str]:
        """Attempt until it succeeds, time runs out, the clock jumps back or the context is shut down."""
        result = attempt()
        limit = duration_ns(timeout)
        if result[0] or limit <= 0:
            return result
        changed = threading.Event()
        self._watch(changed.set)
        try:
            with _Deadline(self.clock, limit, changed.set) as deadline:
                context = self._context
                alive = context.ok()
                if alive:
                    context.on_shutdown(changed.set)
                while not (result := attempt())[0] and context.ok() is alive and not deadline.passed():
                    changed.wait(deadline.timeout_s())
                    changed.clear()
            return result
        finally:
            self._unwatch(changed.set)

    # Looking transforms up in coroutines.

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Time) -> TransformStamped:
        """Return the transform as soon as it is known; see `lookup_transform`."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> TransformStamped:
        """Return the transform as soon as it is known; see `lookup_transform_full`."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*asked)
        return self.lookup_transform_full_core(*asked)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Future:
        """Return a future whose result will be the transform; see `lookup_transform`."""
        return self._future(lambda: self.lookup_transform_core(target_frame, source_frame, time))

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> Future:
        """Return a future whose result will be the transform; see `lookup_transform_full`."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future(lambda: self.lookup_transform_full_core(*asked))

    def _future(self, look_up: Callable[[], TransformStamped | None]) -> Future:
        future = Future()

        def attempt() -> None:
            try:
                transform = look_up()
            except TransformException:
                return
            if self._unwatch(attempt):
                node = self._node() if self._node is not None else None
                future._set_executor(node.executor if node is not None else None)
                future.set_result(transform)

        self._watch(attempt)
        try:
            attempt()
        except Exception:
            self._unwatch(attempt)
            raise

        def forget() -> None:
            self._unwatch(attempt)

        future.on_wake(forget)
        return future


class _Deadline:
    """The end of a span of a clock's time; `wake` is called when simulated time reaches it."""

    def __init__(self, clock: Clock, limit_ns: int, wake: Callable[[], None]) -> None:
        self._clock = clock.handle
        self._simulated = self._clock.overridden
        self._start = self._clock.now_ns()
        self._timer = TimerHandle(self._clock, limit_ns, wake)
        self._wall_end = system_time.monotonic_ns() + limit_ns

    def __enter__(self) -> _Deadline:
        self._timer.attach(None)
        return self

    def __exit__(self, *exception: object) -> None:
        self._timer.cancel_timer()

    def passed(self) -> bool:
        """Return whether it is over, or has lost its meaning since the clock was set back or replaced."""
        if self._clock.overridden is not self._simulated:
            return True
        if self._simulated:
            return self._clock.now_ns() < self._start or self._timer.is_timer_ready()
        return system_time.monotonic_ns() >= self._wall_end

    def timeout_s(self) -> float | None:
        """Return how long to wait in wall time; None for until `wake` is called."""
        return None if self._simulated else max(self._wall_end - system_time.monotonic_ns(), 0) / 1e9


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "geometry_msgs.msg": ("TransformStamped",),
            "rclpy.node": ("Node",),
            "rclpy.time": ("Time",),
            "tf2_msgs.srv": ("FrameGraph",),
        },
    )
