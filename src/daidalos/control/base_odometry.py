"""Wheel odometry of a base: pose, smoothed velocity and samples."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import move_along_arc
from daidalos.common.pose3 import quaternion_from_yaw
from daidalos.samples.odometry import transform_of
from daidalos.samples.sensors import OdometrySample, TransformSample

_ZEROS = (0.0,) * 6


@dataclass(frozen=True)
class OdometryParameters(Parameters):
    """Parameters of the odometry of a controller, as ROS names them."""

    odom_frame_id: str = parameter("odom", "Frame of the odometry.", read_only=True)
    base_frame_id: str = parameter("base_link", "Frame of the base.", read_only=True)
    pose_covariance_diagonal: tuple[float, ...] = parameter(
        _ZEROS, "Variances of the odometry's pose.", length=6, read_only=True
    )
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        _ZEROS, "Variances of the odometry's twist.", length=6, read_only=True
    )
    enable_odom_tf: bool = parameter(
        True, "Whether to publish the transform from odom_frame_id to base_frame_id.", read_only=True
    )


class BaseOdometry:
    """Planar pose of a base, integrated by arcs.

    Parameters
    ----------
    odom_frame, base_frame : str
    pose_covariance, twist_covariance : sequence of 6 floats
        Diagonals over x, y, z and rotations about them.
    window : int
        Over how many cycles velocities are averaged.

    Attributes
    ----------
    pose : array (3,)
        x, y [m] and yaw [rad] in the odometry frame.
    """

    def __init__(
        self,
        odom_frame: str,
        base_frame: str,
        pose_covariance: Sequence[float],
        twist_covariance: Sequence[float],
        window: int = 1,
    ) -> None:
        self.odom_frame, self.base_frame = odom_frame, base_frame
        self._pose_covariance = np.diag(pose_covariance).ravel().astype(np.float64)
        self._twist_covariance = np.diag(twist_covariance).ravel().astype(np.float64)
        self._window = max(window, 1)
        self.reset()

    def reset(self) -> None:
        """Set the pose to the origin and the velocities to zero."""
        self.pose: Array = np.zeros(3)
        self._velocities: deque[tuple[float, float, float]] = deque(maxlen=self._window)

    def move(self, forward: float, turn: float, period: float, sideways: float = 0.0) -> None:
        """Add an arc.

        Parameters
        ----------
        forward, turn, sideways : float
            Travel along the base's axes [m] and change of heading [rad].
        period : float
            How long it took [s].
        """
        self.pose = move_along_arc(self.pose, forward, turn, sideways)
        if period > 0.0:
            self._velocities.append((forward / period, sideways / period, turn / period))

    @property
    def velocity(self) -> tuple[float, float, float]:
        """Smoothed speed ahead, to the left, and turn rate [m/s, m/s, rad/s]."""
        count = len(self._velocities)
        if not count:
            return 0.0, 0.0, 0.0
        ahead, sideways, turn = map(sum, zip(*self._velocities, strict=True))
        return ahead / count, sideways / count, turn / count

    def sample(self, now_ns: int, topic: str) -> OdometrySample:
        """Return the odometry as it is now."""
        ahead, sideways, turn = self.velocity
        return OdometrySample(
            stamp_ns=now_ns,
            topic=topic,
            frame_id=self.odom_frame,
            child_frame_id=self.base_frame,
            position=np.array((self.pose[0], self.pose[1], 0.0)),
            orientation=np.array(quaternion_from_yaw(self.pose[2])),
            linear=np.array((ahead, sideways, 0.0)),
            angular=np.array((0.0, 0.0, turn)),
            pose_covariance=self._pose_covariance,
            twist_covariance=self._twist_covariance,
        )

    def transform(self, now_ns: int, topic: str = "/tf") -> TransformSample:
        """Return the base's pose as a transform."""
        return transform_of(self.sample(now_ns, ""), topic)


def prefixed_frame(frame: str, namespace: str, prefix: str, enabled: bool) -> str:
    """Return a frame with a prefix: the given one, or the controller's namespace where that is empty."""
    if not enabled:
        return frame
    prefix = (prefix or namespace).strip("/")
    return f"{prefix}/{frame}" if prefix else frame
