"""Data of an arm with six axes whose last three meet in one point, the centre of the spherical wrist."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Axis:
    """Range and speed of an axis.

    Attributes
    ----------
    lower, upper : float
        Least and greatest angle [rad].
    speed : float
        Greatest speed [rad/s].
    """

    lower: float
    upper: float
    speed: float

    @classmethod
    def from_degrees(cls, lower: float, upper: float, speed: float) -> Axis:
        """Return an axis from degrees and degrees per second, as data sheets print them."""
        return cls(math.radians(lower), math.radians(upper), math.radians(speed))

    @property
    def middle(self) -> float:
        """Return the middle of the range [rad]."""
        return 0.5 * (self.lower + self.upper)


@dataclass(frozen=True)
class Arm:
    """Dimensions and axes of an arm with a spherical wrist.

    With all angles zero the lower arm stands upright and the forearm points along x of the base, whose origin is on
    the floor, on axis 1. Axis 1 turns about z, axes 2, 3 and 5 about y, axes 4 and 6 about x. The frame tool0 on the
    flange then has its z axis along x of the base, and its x axis downwards.

    Attributes
    ----------
    name : str
        Name of its package without `_description`, such as ``irb120``.
    title : str
        Name that the maker gives it.
    base_height : float
        From the floor to axis 2 [m].
    shoulder_offset : float
        From axis 1 forwards to axis 2 [m].
    lower_arm : float
        From axis 2 to axis 3 [m].
    elbow_offset : float
        From axis 3 upwards to axis 4, at angles zero [m].
    forearm : float
        From axis 3 along axis 4 to the centre of the wrist [m].
    flange : float
        From the centre of the wrist to the flange [m].
    axes : tuple of Axis
        The six axes, from the base.
    payload : float
        Greatest load on the flange [kg].
    mass : float
        Mass of the arm [kg].
    reach : float
        Greatest distance of the centre of the wrist from axis 1 as the maker states it [m].
    source : str
        Document of the maker that the figures refer to.
    acceleration_time : float
        Time in which each axis reaches its full speed [s]: an estimate, since makers do not publish it.
    ramp_time : float
        Time in which each axis reaches its full acceleration [s], an estimate too.
    """

    name: str
    title: str
    base_height: float
    shoulder_offset: float
    lower_arm: float
    elbow_offset: float
    forearm: float
    flange: float
    axes: tuple[Axis, Axis, Axis, Axis, Axis, Axis]
    payload: float
    mass: float
    reach: float
    source: str
    acceleration_time: float = 0.3
    ramp_time: float = 0.1

    def __post_init__(self) -> None:
        """Check the dimensions and the axes."""
        for name in ("base_height", "lower_arm", "forearm"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{self.name}: {name} is {getattr(self, name)}, but must be greater than 0 m")
        for name in ("acceleration_time", "ramp_time"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{self.name}: {name} is {getattr(self, name)}, but must be greater than 0 s")
        for number, axis in enumerate(self.axes, 1):
            if not (axis.lower < axis.upper and axis.speed > 0.0):
                raise ValueError(f"{self.name}: axis {number} needs lower < upper and a speed greater than 0")

    @property
    def dimensions(self) -> NDArray[np.float64]:
        """Return base height, shoulder offset, lower arm, elbow offset, forearm and flange [m]."""
        return np.array(
            [self.base_height, self.shoulder_offset, self.lower_arm, self.elbow_offset, self.forearm, self.flange]
        )

    @property
    def limits(self) -> NDArray[np.float64]:
        """Return the ranges of the axes, an array of shape (6, 2) [rad]."""
        return np.array([[axis.lower, axis.upper] for axis in self.axes])

    @property
    def speeds(self) -> NDArray[np.float64]:
        """Return the greatest speeds of the axes [rad/s]."""
        return np.array([axis.speed for axis in self.axes])

    @property
    def accelerations(self) -> NDArray[np.float64]:
        """Return the greatest accelerations of the axes [rad/s^2]."""
        return self.speeds / self.acceleration_time

    @property
    def wrist_reach(self) -> float:
        """Return the greatest distance of the centre of the wrist from axis 1 at the height of axis 2 [m]."""
        return self.shoulder_offset + self.lower_arm + math.hypot(self.elbow_offset, self.forearm)
