"""Measurements of the filter's state from messages: into its frames, relative or differential."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, normalize, rotation_matrix, rotation_vector
from daidalos.localization.errors import LocalizationError
from daidalos.localization.filters.kalman import Measurement
from daidalos.localization.filters.model import ACCELERATION, ANGLES, PLANAR_ZEROS, rotation
from daidalos.nodes.robot_localization._parameters import FilterParameters, Input

PLANAR_VARIANCE = 1e-6
"""Variance of the variables that are zero on a plane."""

Lookup = Callable[[str, str], Pose]
"""Function that returns the pose of the second frame in the first, or raises a `TransformException`."""


@dataclass
class _PoseMemory:
    """Poses that an input measured before."""

    first: Pose | None = None
    last: tuple[float, Pose, Array] | None = None


class Converter:
    """Measurements of one input.

    Parameters
    ----------
    source : Input
    settings : FilterParameters
    """

    def __init__(self, source: Input, settings: FilterParameters) -> None:
        self._source, self._settings = source, settings
        self._memory = _PoseMemory()

    def forget(self) -> None:
        """Forget the first and the last pose."""
        self._memory = _PoseMemory()

    def convert(self, message: Any, time: float, state: Array, lookup: Lookup) -> list[Measurement]:
        """Return the measurements of a message.

        Parameters
        ----------
        message
            Odometry, PoseWithCovarianceStamped, TwistWithCovarianceStamped or Imu.
        time : float
            When it was measured [s].
        state : ndarray, shape (15,)
            Of the filter, whose angles count where the message measures none.
        lookup : callable

        Raises
        ------
        LocalizationError
            When a value or covariance cannot be used.
        TransformException
            When a transform is not known.
        """
        parts = {"odom": self._odometry, "pose": self._pose, "twist": self._twist, "imu": self._imu}
        return list(parts[self._source.kind](message, time, state, lookup))

    def _odometry(self, message: Any, time: float, state: Array, lookup: Lookup) -> Iterator[Measurement]:
        uses, frames = self._source.uses, self._settings
        if uses[:6].any():
            pose = _pose(message.pose.pose, uses)
            frame, child = message.header.frame_id or frames.world, message.child_frame_id
            if self._source.uses_child_frame and child:
                pose = pose @ lookup(frames.base_link_frame, child).inverse
            yield from self._in_world(frame, pose, message.pose.covariance, time, state, lookup)
        yield from self._velocity(message.child_frame_id, message.twist, time, lookup)

    def _pose(self, message: Any, time: float, state: Array, lookup: Lookup) -> Iterator[Measurement]:
        pose, frame = _pose(message.pose.pose, self._source.uses), message.header.frame_id or self._settings.world
        yield from self._in_world(frame, pose, message.pose.covariance, time, state, lookup)

    def _twist(self, message: Any, time: float, state: Array, lookup: Lookup) -> Iterator[Measurement]:
        yield from self._velocity(message.header.frame_id, message.twist, time, lookup)

    def _imu(self, message: Any, time: float, state: Array, lookup: Lookup) -> Iterator[Measurement]:
        uses, base = self._source.uses, self._settings.base_link_frame
        mount = lookup(base, message.header.frame_id or base)
        turn = rotation_matrix(mount.orientation)
        has_orientation = message.orientation_covariance[0] != -1
        given = _vector(message.orientation)
        if has_orientation and uses[ANGLES].any():
            orientation = _pose_of((0.0, 0.0, 0.0), given) @ Pose((0.0, 0.0, 0.0), mount.orientation).inverse
            covariance = np.zeros((6, 6))
            covariance[3:, 3:] = turn @ _square(message.orientation_covariance, 3) @ turn.T
            yield from self._pose_measurements(orientation, covariance, time, state)
        if message.angular_velocity_covariance[0] != -1:
            values = turn @ _vector(message.angular_velocity)[:3]
            covariance = turn @ _square(message.angular_velocity_covariance, 3) @ turn.T
            yield from self._measured(9, uses[9:12], values, covariance, time, self._source.twist_threshold)
        if message.linear_acceleration_covariance[0] != -1:
            values = turn @ _vector(message.linear_acceleration)[:3]
            if self._source.removes_gravity:
                in_world = np.asarray(rotation(state[ANGLES]), dtype=float)
                if has_orientation and any(given):
                    in_world = rotation_matrix(normalize(given)) @ turn.T
                values = values - in_world.T @ np.array([0.0, 0.0, self._settings.gravitational_acceleration])
            covariance = turn @ _square(message.linear_acceleration_covariance, 3) @ turn.T
            threshold = self._source.acceleration_threshold
            yield from self._measured(12, uses[ACCELERATION], values, covariance, time, threshold)

    def _in_world(
        self, frame: str, pose: Pose, covariance: Any, time: float, state: Array, lookup: Lookup
    ) -> Iterator[Measurement]:
        """Yield the measurement of a pose in a frame."""
        uses = self._source.uses
        if not uses[:6].any():
            return
        place = lookup(self._settings.world, frame)
        turn = np.kron(np.eye(2), rotation_matrix(place.orientation))
        known = _square(covariance, 6, uses[:6])
        yield from self._pose_measurements(place @ pose, turn @ known @ turn.T, time, state)

    def _pose_measurements(self, pose: Pose, covariance: Array, time: float, state: Array) -> Iterator[Measurement]:
        """Yield the measurement of a pose (absolute, relative to the first, or as a velocity)."""
        uses, source, memory = self._source.uses[:6], self._source, self._memory
        if not np.isfinite(covariance[np.ix_(uses, uses)]).all() or (np.diag(covariance)[uses] < 0).any():
            raise LocalizationError("its covariance is not finite, or has a negative variance")
        if source.is_differential:
            before, memory.last = memory.last, (time, pose, covariance)
            if before is not None and time > before[0]:
                yield from self._difference(before, (time, pose, covariance), state)
            return
        if source.is_relative:
            memory.first = memory.first or pose
            turn = np.kron(np.eye(2), rotation_matrix(memory.first.orientation).T)
            pose, covariance = memory.first.inverse @ pose, turn @ covariance @ turn.T
        values = np.array([*pose.position, *pose.rpy])
        yield from self._measured(0, uses, values, covariance, time, source.pose_threshold)

    def _difference(
        self, before: tuple[float, Pose, Array], now: tuple[float, Pose, Array], state: Array
    ) -> Iterator[Measurement]:
        """Yield the velocity between two poses; angles that are not measured are the state's."""
        uses, seconds = self._source.uses[:6], now[0] - before[0]
        start, end = (_with_angles(pose, uses[ANGLES], state[ANGLES]) for _, pose, _ in (before, now))
        step = start.inverse @ end
        values = np.array([*step.position, *rotation_vector(step.orientation)]) / seconds
        turn = np.kron(np.eye(2), rotation_matrix(end.orientation).T)
        covariance = turn @ (before[2] + now[2]) @ turn.T / seconds**2
        yield from self._measured(6, uses, values, covariance, now[0], self._source.pose_threshold)

    def _velocity(self, frame: str, twist: Any, time: float, lookup: Lookup) -> Iterator[Measurement]:
        """Yield the measurement of a velocity in a frame of the robot, moved to its base."""
        uses, base = self._source.uses[6:12], self._settings.base_link_frame
        if not uses.any():
            return
        mount = lookup(base, frame or base)
        turn, (x, y, z) = rotation_matrix(mount.orientation), mount.position
        moved = np.kron(np.eye(2), turn)
        moved[:3, 3:] = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) @ turn
        values = np.array([*_vector(twist.twist.linear), *_vector(twist.twist.angular)])
        values[~uses & ~np.isfinite(values)] = 0.0
        covariance = moved @ _square(twist.covariance, 6, uses) @ moved.T
        yield from self._measured(6, uses, moved @ values, covariance, time, self._source.twist_threshold)

    def _measured(
        self, first: int, uses: NDArray[np.bool_], values: Array, covariance: Array, time: float, threshold: float
    ) -> Iterator[Measurement]:
        """Yield a measurement of those variables from a first one on that are used."""
        if not uses.any():
            return
        at = np.flatnonzero(uses)
        if self._settings.two_d_mode:
            at = at[~np.isin(at + first, PLANAR_ZEROS)]
        if len(at):
            yield Measurement(time, at + first, values[at], covariance[np.ix_(at, at)], threshold)


def planar_measurement(time: float) -> Measurement:
    """Return the measurement that a robot is on a plane."""
    n = len(PLANAR_ZEROS)
    return Measurement(time, PLANAR_ZEROS, np.zeros(n), PLANAR_VARIANCE * np.eye(n))


def _vector(message: Any) -> Any:
    """Return the numbers of a Vector3, Point or Quaternion as a tuple."""
    names = ("x", "y", "z", "w")
    return tuple(float(getattr(message, name)) for name in names if hasattr(message, name))


def _square(values: Any, size: int, uses: NDArray[np.bool_] | None = None) -> Array:
    """Return a covariance; what is not finite is zero in variables that are not used."""
    matrix = np.array(values, dtype=float).reshape(size, size)
    if uses is not None:
        matrix[~np.isfinite(matrix) & ~np.outer(uses, uses)] = 0.0
    return matrix


def _pose(message: Any, uses: NDArray[np.bool_]) -> Pose:
    """Return a message's pose; numbers that are not used may be missing."""
    position, quaternion = np.array(_vector(message.position)), _vector(message.orientation)
    position[~uses[:3] & ~np.isfinite(position)] = 0.0
    if not uses[ANGLES].any() and not (np.isfinite(quaternion).all() and any(quaternion)):
        quaternion = (0.0, 0.0, 0.0, 1.0)
    return _pose_of(tuple(position.tolist()), quaternion)


def _pose_of(position: Any, quaternion: Any) -> Pose:
    """Return a pose.

    Raises
    ------
    LocalizationError
        When a number is not finite, or the quaternion has no length.
    """
    if not (np.isfinite(position).all() and np.isfinite(quaternion).all()):
        raise LocalizationError("its pose is not finite")
    if not any(quaternion):
        raise LocalizationError("its orientation is a quaternion of length 0")
    return Pose(position, normalize(quaternion))


def _with_angles(pose: Pose, uses: NDArray[np.bool_], angles: Array) -> Pose:
    """Return a pose whose angles are replaced where they are not used."""
    roll, pitch, yaw = np.where(uses, pose.rpy, angles).tolist()
    return Pose.from_xyz_rpy(pose.position, (roll, pitch, yaw))
