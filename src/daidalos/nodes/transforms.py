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
    """Static poses of sensors in the robot's base frame.

    Parameters
    ----------
    buffer
        Where they are looked up once.
    base_frame
        The frame of the robot's base.
    logger
        Logs for which sensor a transform is missing.
    """

    def __init__(self, buffer: Buffer, base_frame: str, logger: RcutilsLogger) -> None:
        self._buffer = buffer
        self._base_frame = base_frame
        self._logger = logger
        self._mounts: dict[str, SensorMount] = {}

    def find(self, frame: str) -> SensorMount | None:
        """Return how the sensor of a frame is mounted, None while it is not known, which is logged."""
        mount = self.mount(frame)
        if mount is None:
            self._logger.info(
                f"waiting for the transform from {frame} to {self._base_frame}", throttle_duration_sec=5.0
            )
        return mount

    def mount(self, frame: str) -> SensorMount | None:
        """Return how the sensor of a frame is mounted, None while it is not known."""
        if frame not in self._mounts:
            try:
                found = self._buffer.lookup_transform(self._base_frame, frame, Time())
            except TransformException:
                return None
            self._mounts[frame] = mount_of_transform(found.transform)
        return self._mounts[frame]

    def missing(self, frame: str) -> str:
        """Return why the transform of a sensor is not known, with the frames that are."""
        known = sorted(self._buffer._getFrameStrings())
        unknown = [name for name in (frame, self._base_frame) if name not in known]
        if not unknown:
            return f"waiting for the transform from {frame} to {self._base_frame}, two frames that are not connected"
        problem = " and ".join(f"there is no frame '{name}'" for name in unknown)
        return f"waiting for the transform from {frame} to {self._base_frame}: {problem}{hint(unknown[0], known)}"
