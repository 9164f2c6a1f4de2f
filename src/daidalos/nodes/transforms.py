"""Waiting for the transform of a message, except if it cannot arrive any more."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.time import Time
from tf2_py import TransformException
from tf2_ros import Buffer

from daidalos.common.suggestions import hint
from daidalos.nodes.conversions import SensorMount, mount_of_transform
from daidalos.samples.fields import nanoseconds

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.impl.rcutils_logger import RcutilsLogger
    from rclpy.task import Future

_AHEAD_NS = 1_000_000_000
"""Time ahead of the clock beyond which a message must be from before the clock was set back."""


class BlockingBuffer(Buffer):
    """Transform buffer that waits for the transform at a message's time."""

    def transform_at(self, target_frame: str, source_frame: str, stamp: Any) -> Future:
        """Return a future of the transform from one frame to another at a message's time.

        Its result is None when the transform cannot come any more: only later ones are known, or the clock was set
        back since. Who waits for it in a callback would otherwise keep out all messages to come.

        Parameters
        ----------
        target_frame, source_frame
            Names.
        stamp
            ``builtin_interfaces.msg.Time`` of the message.
        """
        stamp_ns = nanoseconds(stamp)

        def look_up() -> TransformStamped | None:
            try:
                return self.lookup_transform_core(target_frame, source_frame, stamp)
            except TransformException:
                if 0 < self.clock.now().nanoseconds < stamp_ns - _AHEAD_NS:
                    return None
                newest = self.lookup_transform_core(target_frame, source_frame, Time())
                if nanoseconds(newest.header.stamp) > stamp_ns:
                    return None
                raise

        return self._future(look_up)


class SensorPoses:
    """Poses of sensors in the robot's base frame.

    Parameters
    ----------
    buffer
        Where they are looked up: once, or each time for a sensor that is moved.
    base_frame
        The frame of the robot's base.
    logger
        Logs for which sensor a transform is missing.
    fixed_frame
        Frame in which the robot moves: data of sensors that do not move with the robot are refused. Any are accepted
        where it is empty.
    """

    def __init__(self, buffer: Buffer, base_frame: str, logger: RcutilsLogger, fixed_frame: str = "") -> None:
        self._buffer = buffer
        self._base_frame = base_frame
        self._logger = logger
        self._fixed_frame = fixed_frame
        self._static: dict[str, Any] = {}

    def find(self, frame: str) -> SensorMount | None:
        """Return how the sensor of a frame is mounted, None while it is not known, which is logged."""
        found = self.transform(frame)
        return None if found is None else mount_of_transform(found)

    def transform(self, frame: str) -> Any | None:
        """Return the transform of a sensor to the base, None while it is not known, which is logged."""
        found, problem = self._look_up(frame)
        if found is None:
            self._logger.info(problem, throttle_duration_sec=5.0)
        return found

    def mount(self, frame: str) -> SensorMount | None:
        """Return how the sensor of a frame is mounted, None while it is not known."""
        found, _ = self._look_up(frame)
        return None if found is None else mount_of_transform(found)

    def _look_up(self, frame: str) -> tuple[Any, str]:
        """Return the transform of a sensor, or None and why it is not known."""
        if frame in self._static:
            return self._static[frame], ""
        try:
            found = self._buffer.lookup_transform(self._base_frame, frame, Time())
        except TransformException:
            return None, f"waiting for the transform from {frame} to {self._base_frame}"
        if not nanoseconds(found.header.stamp):
            self._static[frame] = found.transform
        elif self._fixed_frame and self._fixed_frame in self._buffer._chain(
            self._base_frame, Time(), frame, Time(), self._base_frame
        ):
            return None, f"data in the frame '{frame}' are refused: it does not move with the robot"
        return found.transform, ""

    def missing(self, frame: str) -> str:
        """Return why the transform of a sensor is not known, with the frames that are."""
        known = sorted(self._buffer._getFrameStrings())
        unknown = [name for name in (frame, self._base_frame) if name not in known]
        if not unknown:
            return f"waiting for the transform from {frame} to {self._base_frame}, two frames that are not connected"
        problem = " and ".join(f"there is no frame '{name}'" for name in unknown)
        return f"waiting for the transform from {frame} to {self._base_frame}: {problem}{hint(unknown[0], known)}"
