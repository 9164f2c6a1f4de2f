"""The buffer: a tree of frames with the recent history of every transform."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from . import _report
from ._history import Fixed, History, Item, motion_of
from ._messages import check_name, message, read
from ._paths import latest_common, parent_of, path
from ._rigid import IDENTITY, Rigid, canonical, chain, compose, inverse
from ._times import duration_ns, time_ns
from .exceptions import (
    InvalidArgumentException,
    LookupException,
    TransformException,
)

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.duration import Duration
    from rclpy.time import Time

_CACHE_TIME_NS = 10_000_000_000
_ROUNDING = 1e-12
_TOLERANCE = 1e-2


Entry = tuple[int, str, Item]
"""A transform as buffers keep it: its stamp in nanoseconds, the child, and the parent with the motion."""


class BufferCore:
    """Buffer of transforms, which computes the transform between two frames, now or in the past.

    Every frame remembers its transform to its parent over the last `cache_time`; between two of them it is
    interpolated, linearly and along the shorter arc. All methods may be called from any thread.

    Parameters
    ----------
    cache_time
        How long transforms are remembered, 10 s by default.
    """

    def __init__(self, cache_time: Duration | None = None) -> None:
        self._age_ns = _CACHE_TIME_NS if cache_time is None else duration_ns(cache_time)
        self._frames: dict[str, History | Fixed | None] = {}
        self._authorities: dict[str, str] = {}
        self._lock = threading.RLock()
        self._watchers: tuple[Callable[[], None], ...] = ()

    # Taking transforms in.

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Insert a transform; an invalid one is logged and ignored.

        Parameters
        ----------
        transform
            From its ``child_frame_id`` to its ``header.frame_id``, at ``header.stamp``.
        authority
            Who says so.
        """
        self._set(transform, authority, History)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Insert a transform that holds at all times; see `set_transform`."""
        self._set(transform, authority, Fixed)

    def _set(self, transform: Any, authority: str, kind: type[History] | type[Fixed]) -> None:
        entry = checked(transform, authority)
        if entry is not None:
            self._insert((entry,), authority, kind)

    def _insert(self, entries: Iterable[Entry], authority: str, kind: type[History] | type[Fixed]) -> None:
        """Insert transforms that `checked` returned."""
        frames, authorities = self._frames, self._authorities
        late: list[Entry] = []
        with self._lock:
            for entry in entries:
                stamp, child, item = entry
                history = frames.get(child)
                if history.__class__ is not kind:
                    history = frames[child] = History(self._age_ns) if kind is History else Fixed()
                if item[0] not in frames:
                    frames[item[0]] = None
                if history.insert(stamp, item):
                    authorities[child] = authority
                else:
                    late.append(entry)
        for stamp, child, _ in late:
            _report.old_data(child, stamp, authority)
        if self._watchers:
            self._notify_listeners()

    def clear(self) -> None:
        """Remove all transforms, except those that hold at all times."""
        with self._lock:
            for history in self._frames.values():
                if history is not None:
                    history.clear()
        self._notify_listeners()

    def _watch(self, watcher: Callable[[], None]) -> None:
        """Call `watcher` after every change, on the thread that makes it."""
        with self._lock:
            self._watchers = (*self._watchers, watcher)

    def _unwatch(self, watcher: Callable[[], None]) -> bool:
        """Call it no more; return whether it was watching."""
        with self._lock:
            before = len(self._watchers)
            self._watchers = tuple(other for other in self._watchers if other != watcher)
            return len(self._watchers) < before

    def _notify_listeners(self) -> None:
        for watcher in self._watchers:
            watcher()

    # Looking transforms up.

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Time) -> TransformStamped:
        """Return the transform that takes coordinates in the source frame to the target frame.

        Parameters
        ----------
        target_frame, source_frame
            Names.
        time
            When; zero means the newest time at which it is known.

        Raises
        ------
        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException
            When it is not known.
        """
        stamp, motion = self._lookup(target_frame, source_frame, time_ns(time))
        return message(stamp, target_frame, source_frame, motion)

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> TransformStamped:
        """Return the transform from the source frame at one time to the target frame at another.

        Parameters
        ----------
        target_frame, target_time, source_frame, source_time
            As in `lookup_transform_core`.
        fixed_frame
            The frame that does not move between the two times.

        Raises
        ------
        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException
            When it is not known.
        """
        target_ns, source_ns = time_ns(target_time), time_ns(source_time)
        with self._lock:
            for argument, frame in (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame)):
                self._require(f"lookupTransform argument {argument}_frame", frame)
            _, to_fixed = self._lookup(fixed_frame, source_frame, source_ns)
            stamp, from_fixed = self._lookup(target_frame, fixed_frame, target_ns)
        return message(stamp, target_frame, source_frame, canonical(compose(from_fixed, to_fixed)))

    def can_transform_core(self, target_frame: str, source_frame: str, time: Time) -> tuple[bool, str]:
        """Return whether `lookup_transform_core` would find the transform, and if not, why."""
        problem = self._problem(target_frame, source_frame, time_ns(time))
        return not problem, problem

    def can_transform_full_core(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return whether `lookup_transform_full_core` would find the transform, and if not, why."""
        target_ns, source_ns = time_ns(target_time), time_ns(source_time)
        with self._lock:
            problem = (
                self._frame_problem("target_frame", target_frame)
                or self._frame_problem("source_frame", source_frame)
                or self._frame_problem("fixed_frame", fixed_frame)
                or self._problem(target_frame, fixed_frame, target_ns)
                or self._problem(fixed_frame, source_frame, source_ns)
            )
        return not problem, problem

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the newest time at which the transform between two frames is known.

        Returns
        -------
        Time
            Zero where the transform holds at all times.

        Raises
        ------
        LookupException
            When a frame is unknown.
        TransformException
            When they are not connected.
        """
        from rclpy.time import Time

        with self._lock:
            self._require("get_latest_common_time", target_frame)
            self._require("get_latest_common_time", source_frame)
            if target_frame == source_frame:
                return Time(nanoseconds=self._latest(target_frame))
            try:
                return Time(nanoseconds=latest_common(self._frames, target_frame, source_frame))
            except TransformException as error:
                raise TransformException(str(error)) from None

    def get_cache_time(self) -> Duration:
        """Return how long transforms are remembered."""
        from rclpy.duration import Duration

        return Duration(nanoseconds=self._age_ns)

    def _lookup(self, target: str, source: str, stamp: int) -> tuple[int, Rigid]:
        """Return the time (another one than `stamp` if that is zero) and the motion."""
        with self._lock:
            if target == source:
                return stamp or self._latest(target), IDENTITY
            if target not in self._frames or source not in self._frames:
                self._require("lookupTransform argument target_frame", target)
                self._require("lookupTransform argument source_frame", source)
            stamp = stamp or latest_common(self._frames, target, source)
            upward, downward = path(self._frames, target, source, stamp)
        motion = chain(map(motion_of, upward))
        if downward:
            back = inverse(chain(map(motion_of, downward)))
            motion = compose(back, motion) if upward else back
        return stamp, canonical(motion)

    def _problem(self, target: str, source: str, stamp: int) -> str:
        """Return why there is no such transform, "" when there is one."""
        if target == source:
            return ""
        with self._lock:
            problem = self._frame_problem("target_frame", target) or self._frame_problem("source_frame", source)
            if problem:
                return problem
            try:
                path(self._frames, target, source, stamp or latest_common(self._frames, target, source))
            except TransformException as error:
                return str(error)
            return ""

    def _latest(self, frame: str) -> int:
        history = self._frames.get(frame)
        return 0 if history is None else history.latest()[0]

    def _require(self, argument: str, frame: str) -> None:
        """Raise unless the frame is known."""
        check_name(frame)
        if frame in self._frames:
            return
        if not frame:
            raise InvalidArgumentException(
                f'Invalid argument "{frame}" passed to {argument} - in tf2 frame_ids cannot be empty'
            )
        if frame[0] == "/":
            raise InvalidArgumentException(
                f"Invalid argument \"{frame}\" passed to {argument} - in tf2 frame_ids cannot start with a '/'"
            )
        raise LookupException(f'"{frame}" passed to {argument} does not exist. ')

    def _frame_problem(self, argument: str, frame: str) -> str:
        """Return why a frame cannot be looked up, "" when it can."""
        if frame in self._frames:
            return ""
        check_name(frame)
        if not frame:
            reason = "in tf2 frame_ids cannot be empty"
        elif frame[0] == "/":
            reason = "in tf2 frame_ids cannot start with a '/'"
        else:
            reason = "frame does not exist"
        return f'Invalid frame ID "{frame}" passed to canTransform argument {argument} - {reason}'

    # Showing the tree.

    def all_frames_as_string(self) -> str:
        """Return one sentence for every frame that has a parent."""
        with self._lock:
            return _report.as_sentences(self._frames)

    def all_frames_as_yaml(self) -> str:
        """Return the tree, with rates and times, as YAML."""
        with self._lock:
            return _report.as_yaml(self._frames, self._authorities)

    def _allFramesAsDot(self, time: Time | None = None) -> str:
        with self._lock:
            return _report.as_dot(self._frames, self._authorities, 0 if time is None else time_ns(time))

    def _frameExists(self, frame_id_str: str) -> bool:
        return frame_id_str in self._frames

    def _getFrameStrings(self) -> list[str]:
        with self._lock:
            return list(self._frames)

    def _chain(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> list[str]:
        """Return the frames between the source and the target, by way of the fixed frame."""
        with self._lock:
            names = self._frames_between(fixed_frame, source_frame, time_ns(source_time))
            names += self._frames_between(target_frame, fixed_frame, time_ns(target_time))
        return names

    def _frames_between(self, target: str, source: str, stamp: int) -> list[str]:
        self._require("lookupTransform argument target_frame", target)
        self._require("lookupTransform argument source_frame", source)
        if target == source:
            return []
        upward, downward = path(self._frames, target, source, stamp or latest_common(self._frames, target, source))
        up = [source, *map(parent_of, upward)]
        down = [target, *map(parent_of, downward)]
        return up + down[-2::-1]

    # Velocities.

    def lookupVelocityCore(
        self, tracking_frame: str, observation_frame: str, time: Time, averaging_interval: Duration
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return how fast a frame moves and turns, as another one sees it.

        Parameters
        ----------
        tracking_frame, observation_frame
            The moving frame, and the one whose axes the result is in.
        time, averaging_interval
            The middle and the length of the span to average over.

        Returns
        -------
        (linear, angular)
            In m/s and rad/s.

        Raises
        ------
        LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException
            When a transform is not known.
        """
        from ._velocity import velocity

        latest_ns = self.get_latest_common_time(observation_frame, tracking_frame).nanoseconds
        span_ns = duration_ns(averaging_interval)
        return velocity(self._lookup, latest_ns, tracking_frame, observation_frame, time_ns(time), span_ns)

    def lookupVelocityFullCore(
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        reference_point: tuple[float, float, float],
        reference_point_frame: str,
        time: Time,
        averaging_interval: Duration,
    ) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return the same for a point that moves with the tracking frame, in the axes of `reference_frame`.

        Parameters
        ----------
        reference_frame
            The frame whose axes the result is in.
        reference_point, reference_point_frame
            The point whose velocity is asked for.
        tracking_frame, observation_frame, time, averaging_interval
            As in `lookupVelocityCore`.
        """
        from ._velocity import velocity_of_point

        return velocity_of_point(
            self._lookup,
            self.get_latest_common_time(observation_frame, tracking_frame).nanoseconds,
            tracking_frame,
            observation_frame,
            reference_frame,
            reference_point,
            reference_point_frame,
            time_ns(time),
            duration_ns(averaging_interval),
        )


def checked(transform: Any, authority: str) -> Entry | None:
    """Return a message of a transform as buffers keep it; None, after an error was logged, for an invalid one."""
    stamp, parent, child, motion = read(transform)
    x, y, z, a, b, c, d = motion
    squared = a * a + b * b + c * c + d * d
    if not -_TOLERANCE < squared - 1.0 < _TOLERANCE or x + y + z != x + y + z or not parent or not child:
        problem = _report.problem_with(parent, child, motion, authority, _TOLERANCE)
        if problem:
            _report.error(problem)
            return None
    if parent[0] == "/" or child[0] == "/":
        parent, child = parent.removeprefix("/"), child.removeprefix("/")
    if parent == child or not parent or not child:
        _report.error(_report.problem_with(parent, child, motion, authority, _TOLERANCE))
        return None
    if not -_ROUNDING < squared - 1.0 < _ROUNDING:
        scale = squared**-0.5
        motion = (x, y, z, a * scale, b * scale, c * scale, d * scale)
    return stamp, child, (parent, motion)


class SharedEntries:
    """Entries of the message that came last, read once for all buffers of a process that get it.

    Only for messages that nobody changes.
    """

    def __init__(self) -> None:
        self._last: tuple[Any, list[Entry]] = None, []

    def of(self, message: Any, authority: str) -> list[Entry]:
        """Return the valid transforms of a ``tf2_msgs/msg/TFMessage``."""
        last, entries = self._last
        if message is not last:
            found = (checked(transform, authority) for transform in message.transforms)
            entries = [entry for entry in found if entry is not None]
            self._last = message, entries
        return entries
