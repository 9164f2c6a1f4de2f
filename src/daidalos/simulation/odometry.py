"""Odometry from wheels: what encoders measure, and the pose that follows from it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.simulation.samples import OdometrySample, TransformSample

Array = NDArray[np.float64]

_UNKNOWN = 1e12


@dataclass(frozen=True)
class PlanarPose:
    """Position [m] and heading [rad] in the plane."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def moved(self, forward: float, turn: float, sideways: float = 0.0) -> PlanarPose:
        """Return the pose after an arc.

        Parameters
        ----------
        forward, sideways : float
            Travel along the body's x and y axis over the arc [m].
        turn : float
            Change of heading over the arc [rad].
        """
        half = turn / 2
        chord = math.sin(half) / half if abs(half) > 1e-9 else 1.0
        middle = self.yaw + half
        dx = chord * (forward * math.cos(middle) - sideways * math.sin(middle))
        dy = chord * (forward * math.sin(middle) + sideways * math.cos(middle))
        return PlanarPose(self.x + dx, self.y + dy, self.yaw + turn)


@dataclass(frozen=True)
class EncoderError:
    """How a wheel's measured travel differs from what it really rolled.

    Parameters
    ----------
    noise : float
        Standard deviation of the error after one metre [m]; it grows with the square root of the
        distance, whatever the rate of measuring.
    slip : float
        Share of the travel that is measured too much.
    """

    noise: float = 0.0
    slip: float = 0.0

    def measure(self, travel: Array, random: np.random.Generator) -> Array:
        """Return the measured travel of wheels since the last measurement [m]."""
        measured = travel * (1.0 + self.slip)
        if self.noise:
            measured = measured + random.normal(0.0, 1.0, len(travel)) * self.noise * np.sqrt(np.abs(travel))
        return measured


def yaw_quaternion(yaw: float) -> Array:
    """Return the quaternion x, y, z, w of a turn about z."""
    return np.array((0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))


def planar_covariance(x: float, y: float, yaw: float) -> Array:
    """Return a (36,) covariance of a pose or twist in the plane; what is out of the plane is unknown."""
    return np.diag((x, y, _UNKNOWN, _UNKNOWN, _UNKNOWN, yaw)).ravel()


def transform_of(odometry: OdometrySample, topic: str) -> TransformSample:
    """Return the transform that an odometry says."""
    return TransformSample(
        stamp_ns=odometry.stamp_ns,
        topic=topic,
        frame_id=odometry.frame_id,
        child_frame_id=odometry.child_frame_id,
        translation=odometry.position,
        rotation=odometry.orientation,
    )
