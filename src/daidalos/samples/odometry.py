"""Samples of the odometry of planar bases."""

from __future__ import annotations

from functools import cache

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import quaternion_from_yaw
from daidalos.samples.sensors import OdometrySample, TransformSample

_UNKNOWN = 1e12


@cache
def planar_covariance(x: float, y: float, yaw: float) -> Array:
    """Return a (36,) covariance of a planar pose or twist, to be read only; those out of the plane are unknown."""
    covariance = np.diag((x, y, _UNKNOWN, _UNKNOWN, _UNKNOWN, yaw)).ravel()
    covariance.flags.writeable = False
    return covariance


def wheel_odometry(
    stamp_ns: int,
    topic: str,
    frames: tuple[str, str],
    pose: Array,
    velocity: tuple[float, float, float],
    covariance: tuple[float, float, float] = (1e-5, 1e-5, 1e-3),
) -> OdometrySample:
    """Return a base's odometry from its wheels.

    Parameters
    ----------
    stamp_ns, topic : int, str
    frames : tuple of 2 str
        Of the odometry and of the base.
    pose : array (3,)
        Of the base in the odometry frame: x, y [m] and yaw [rad].
    velocity : tuple of 3 floats
        Ahead and to the left in the base's frame [m/s], and of turning [rad/s].
    covariance : tuple of 3 floats
        Variances of x, y and yaw.
    """
    ahead, left, turn = velocity
    spread = planar_covariance(*covariance)
    return OdometrySample(
        stamp_ns=stamp_ns,
        topic=topic,
        frame_id=frames[0],
        child_frame_id=frames[1],
        position=np.array((pose[0], pose[1], 0.0)),
        orientation=np.array(quaternion_from_yaw(pose[2])),
        linear=np.array((ahead, left, 0.0)),
        angular=np.array((0.0, 0.0, turn)),
        pose_covariance=spread,
        twist_covariance=spread,
    )


def transform_of(odometry: OdometrySample, topic: str) -> TransformSample:
    """Return the transform of an odometry sample."""
    return TransformSample(
        stamp_ns=odometry.stamp_ns,
        topic=topic,
        frame_id=odometry.frame_id,
        child_frame_id=odometry.child_frame_id,
        translation=odometry.position,
        rotation=odometry.orientation,
    )
