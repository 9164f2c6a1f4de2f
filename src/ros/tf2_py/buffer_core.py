"""The buffer: a tree of frames with the recent history of every transform."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import _report
from ._history import Fixed, History, Item, motion_of
from ._rigid import IDENTITY, Rigid, canonical, chain, compose, inverse
from ._times import duration_ns, time_ns
from .exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.duration import Duration
    from rclpy.time import Time

_CACHE_TIME_NS = 10_000_000_000
_MAX_DEPTH = 1000
_ROUNDING = 1e-12
_TOLERANCE = 1e-2


class BufferCore:
    """Stores transforms and answers what the transform between two frames is, or was.

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
        """Take in a transform; one that makes no sense is logged and ignored.

        Parameters
        ----------
        transform
            From its ``child_frame_id`` to its ``header.frame_id``, at ``header.stamp``.
        authority
            Who says so.
        """
        self._set(transform, authority, History)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Take in a transform that holds at all times; see `set_transform`."""
        self._set(transform, authority, Fixed)

    def _set(self, transform: Any, authority: str, kind: type[History] | type[Fixed]) -> None:
        stamp, parent, child, motion = _read(transform)
        x, y, z, a, b, c, d = motion
        squared = a * a + b * b + c * c + d * d
        if not -_TOLERANCE < squared - 1.0 < _TOLERANCE or x + y + z != x + y + z or not parent or not child:
            problem = _report.problem_with(parent, child, motion, authority, _TOLERANCE)
            if problem:
                _report.error(problem)
                return
        if parent[0] == "/" or child[0] == "/":
            parent, child = parent.removeprefix("/"), child.removeprefix("/")
        if parent == child or not parent or not child:
            _report.error(_report.problem_with(parent, child, motion, authority, _TOLERANCE))
            return
        if not -_ROUNDING < squared - 1.0 < _ROUNDING:
            scale = squared**-0.5
            motion = (x, y, z, a * scale, b * scale, c * scale, d * scale)
        with self._lock:
            history = self._frames.get(child)
            if history.__class__ is not kind:
                history = self._frames[child] = History(self._age_ns) if kind is History else Fixed()
            if parent not in self._frames:
                self._frames[parent] = None
            accepted = history.insert(stamp, (parent, motion))
            if accepted:
                self._authorities[child] = authority
        if not accepted:
            _report.old_data(child, stamp, authority)
        elif self._watchers:
            self._tell_watchers()

    def clear(self) -> None:
        """Forget all transforms, except those that hold at all times."""
        with self._lock:
            for history in self._frames.values():
                if history is not None:
                    history.clear()
        self._tell_watchers()

    def _watch(self, watcher: Callable[[], None]) -> None:
        """Call `watcher` after every change, on the thread that makes it."""
        with self._lock:
            self._watchers = (*self._watchers, watcher)

    def _unwatch(self, watcher: Callable[[], None]) -> bool:
        """Call it no more; tell whether it was watching."""
        with self._lock:
            before = len(self._watchers)
            self._watchers = tuple(other for other in self._watchers if other != watcher)
            return len(self._watchers) < before

    def _tell_watchers(self) -> None:
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
        return _message(stamp, target_frame, source_frame, motion)

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
        return _message(stamp, target_frame, source_frame, canonical(compose(from_fixed, to_fixed)))

    def can_transform_core(self, target_frame: str, source_frame: str, time: Time) -> tuple[bool, str]:
        """Tell whether `lookup_transform_core` would find the transform, and if not, why."""
        problem = self._problem(target_frame, source_frame, time_ns(time))
        return not problem, problem

    def can_transform_full_core(
        self, target_frame: str, target_time: Time, source_frame: str, source_time: Time, fixed_frame: str
    ) -> tuple[bool, str]:
        """Tell whether `lookup_transform_full_core` would find the transform, and if not, why."""
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
                return Time(nanoseconds=self._latest_common(target_frame, source_frame))
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
            stamp = stamp or self._latest_common(target, source)
            upward, downward = self._path(target, source, stamp)
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
                self._path(target, source, stamp or self._latest_common(target, source))
            except TransformException as error:
                return str(error)
            return ""

    def _path(self, target: str, source: str, stamp: int) -> tuple[list[Any], list[Any]]:
        """Return what `History.at` gives for the frames from the source, and from the target, to where they meet."""
        frames = self._frames
        upward: list[Any] = []
        places: dict[str, int] = {}
        failure: str | None = None
        frame = source
        while frame != target:
            history = frames[frame]
            if history is None:
                break
            found = history.at(stamp)
            if isinstance(found, str):
                failure = found  # the way down from here may still lead to the target
                break
            if frame in places:
                raise self._loop()
            places[frame] = len(upward)
            upward.append(found)
            frame = _parent(found)
        top = frame
        downward: list[Any] = []
        frame = target
        while frame != top:
            if frame in places:
                del upward[places[frame] :]
                break
            history = frames[frame]
            if history is None:
                if failure is not None:
                    raise ExtrapolationException(_between(failure, source, target))
                raise _unconnected(target, source)
            found = history.at(stamp)
            if isinstance(found, str):
                raise ExtrapolationException(_between(found, source, target))
            downward.append(found)
            frame = _parent(found)
            if len(downward) > _MAX_DEPTH:
                raise self._loop()
        return upward, downward

    def _latest_common(self, target: str, source: str) -> int:
        """Return the newest time at which all transforms between two frames are known, zero for any time."""
        frames = self._frames
        newest: dict[str, int] = {}  # parent: the oldest of the newest stamps on the way to it
        common = 0
        frame = source
        while frame != target:
            history = frames[frame]
            stamp, parent = (0, "") if history is None else history.latest()
            if not parent:
                break
            if stamp and (stamp < common or not common):
                common = stamp
            if parent in newest:
                raise self._loop()
            newest[parent] = common
            frame = parent
        else:
            return common
        common = 0
        frame = target
        depth = 0
        while frame != source:
            history = frames[frame]
            stamp, parent = (0, "") if history is None else history.latest()
            if not parent:
                raise _unconnected(target, source)
            if stamp and (stamp < common or not common):
                common = stamp
            if parent in newest:
                other = newest[parent]
                return min(common, other) if common and other else common or other
            frame = parent
            depth += 1
            if depth > _MAX_DEPTH:
                raise self._loop()
        return common

    def _latest(self, frame: str) -> int:
        history = self._frames.get(frame)
        return 0 if history is None else history.latest()[0]

    def _require(self, argument: str, frame: str) -> None:
        """Raise unless the frame is known."""
        _check_name(frame)
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
        _check_name(frame)
        if not frame:
            reason = "in tf2 frame_ids cannot be empty"
        elif frame[0] == "/":
            reason = "in tf2 frame_ids cannot start with a '/'"
        else:
            reason = "frame does not exist"
        return f'Invalid frame ID "{frame}" passed to canTransform argument {argument} - {reason}'

    def _loop(self) -> LookupException:
        frames = self.all_frames_as_string()
        return LookupException(f"The tf tree is invalid because it contains a loop.\n{frames}\n")

    # Showing the tree.

    def all_frames_as_string(self) -> str:
        """Return one sentence for every frame that has a parent."""
        with self._lock:
            return "".join(
                f"Frame {frame} exists with parent {history.latest()[1] or 'NO_PARENT'}.\n"
                for frame, history in self._frames.items()
                if history is not None
            )

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
        upward, downward = self._path(target, source, stamp or self._latest_common(target, source))
        up = [source, *map(_parent, upward)]
        down = [target, *map(_parent, downward)]
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

        return velocity(self, tracking_frame, observation_frame, time_ns(time), duration_ns(averaging_interval))

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
            self,
            tracking_frame,
            observation_frame,
            reference_frame,
            reference_point,
            reference_point_frame,
            time_ns(time),
            duration_ns(averaging_interval),
        )


def _parent(found: tuple[Item, Item, float] | Item) -> str:
    parent = found[0]
    return parent if parent.__class__ is str else parent[0]


def _between(problem: str, source: str, target: str) -> str:
    return f"{problem}, when looking up transform from frame [{source}] to frame [{target}]"


def _unconnected(target: str, source: str) -> ConnectivityException:
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )


def _check_name(frame: object) -> None:
    if not isinstance(frame, str):
        raise TypeError(f"a frame's name must be a str, not {type(frame).__name__}")


def _read(transform: Any) -> tuple[int, str, str, Rigid]:
    """Return the stamp in nanoseconds, the parent, the child and the motion of a message."""
    try:
        # A message's slots are a third faster to read than its properties, and /tf is the busiest of topics.
        header = transform._header
        stamp = header._stamp
        translation, rotation = transform._transform._translation, transform._transform._rotation
        return (
            stamp._sec * 1_000_000_000 + stamp._nanosec,
            header._frame_id,
            transform._child_frame_id,
            (
                translation._x,
                translation._y,
                translation._z,
                rotation._x,
                rotation._y,
                rotation._z,
                rotation._w,
            ),
        )
    except AttributeError:
        return _read_any(transform)


def _read_any(transform: Any) -> tuple[int, str, str, Rigid]:
    """Do the same for anything that looks like the message."""
    header, moved = transform.header, transform.transform
    parent, child = header.frame_id, transform.child_frame_id
    for frame in (parent, child):
        _check_name(frame)
    translation, rotation = moved.translation, moved.rotation
    try:
        motion = (
            float(translation.x),
            float(translation.y),
            float(translation.z),
            float(rotation.x),
            float(rotation.y),
            float(rotation.z),
            float(rotation.w),
        )
    except AttributeError:
        raise TypeError("transform.translation must have x, y, z, and transform.rotation x, y, z, w") from None
    return time_ns(header.stamp), parent, child, motion


def _message(stamp: int, target: str, source: str, motion: Rigid) -> TransformStamped:
    from builtin_interfaces.msg import Time
    from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
    from std_msgs.msg import Header

    x, y, z, a, b, c, d = motion
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return TransformStamped(
        header=Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=target),
        child_frame_id=source,
        transform=Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=a, y=b, z=c, w=d)),
    )
