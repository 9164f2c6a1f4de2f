"""Data of an arm with seven axes and no spherical wrist, and of a robot with two of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, Vector
from daidalos.industry.robots.arm import Axis

AXES = 7


@dataclass(frozen=True)
class Capsule:
    """Space that a link takes up: all points up to a distance from a line.

    Attributes
    ----------
    start, end : tuple of 3 floats
        Ends of the line in the link's frame [m].
    radius : float
        [m].
    """

    start: Vector
    end: Vector
    radius: float


@dataclass(frozen=True)
class RedundantArm:
    """Dimensions and axes of an arm with seven axes.

    With all angles zero the frames of all links are parallel to the base, whose z axis is axis 1. The frame tool0 on
    the flange then has its z axis along x of the base, and its x axis downwards.

    Attributes
    ----------
    name, title : str
        Name for commands, and the maker's name.
    offsets : tuple of 8 points
        From the base to the first axis, from each axis to the next, and to the flange, at angles zero [m].
    directions : tuple of 7 unit vectors
        Of the axes, at angles zero.
    numbers : tuple of 7 int
        Numbers that the controller gives the axes, from the base.
    axes : tuple of 7 Axis
        Ranges and speeds, from the base.
    shoulder : point
        Point on axis 1 from which the arm angle is measured, in the base [m].
    elbow_axis, wrist_axis : int
        Index of the axis whose direction is that of the elbow, and of the axis whose origin is the wrist, as the arm
        angle takes them.
    links : tuple of 8 tuples of Capsule
        Space of the base and of the seven links, each in its own frame.
    payload, mass, reach : float
        As in `Arm`.
    source : str
        Document of the maker that the figures refer to.
    """

    name: str
    title: str
    offsets: tuple[Vector, ...]
    directions: tuple[Vector, ...]
    numbers: tuple[int, ...]
    axes: tuple[Axis, ...]
    shoulder: Vector
    elbow_axis: int
    wrist_axis: int
    links: tuple[tuple[Capsule, ...], ...]
    payload: float
    mass: float
    reach: float
    source: str

    def __post_init__(self) -> None:
        """Check the counts and the axes."""
        for name, count in (("offsets", AXES + 1), ("directions", AXES), ("numbers", AXES), ("axes", AXES)):
            if len(getattr(self, name)) != count:
                raise ValueError(f"{self.name}: {name} has {len(getattr(self, name))} entries, but must have {count}")
        for number, axis in zip(self.numbers, self.axes, strict=True):
            if not (axis.lower < axis.upper and axis.speed > 0.0):
                raise ValueError(f"{self.name}: axis {number} needs lower < upper and a speed greater than 0")

    @property
    def geometry(self) -> NDArray[np.float64]:
        """Return offsets, directions and the shoulder, an array of shape (16, 3)."""
        return np.array([*self.offsets, *self.directions, self.shoulder])

    @property
    def limits(self) -> NDArray[np.float64]:
        """Return the ranges of the axes, an array of shape (7, 2) [rad]."""
        return np.array([[axis.lower, axis.upper] for axis in self.axes])

    @property
    def speeds(self) -> NDArray[np.float64]:
        """Return the greatest speeds of the axes [rad/s]."""
        return np.array([axis.speed for axis in self.axes])

    @property
    def controller_order(self) -> NDArray[np.intp]:
        """Return the indices of the axes in the order of their numbers: axis 1 first, axis 7 last."""
        return np.argsort(self.numbers)


@dataclass(frozen=True)
class TwoArmedRobot:
    """A body that carries two arms of the same kind.

    Attributes
    ----------
    name, title : str
        Name of its package without `_description`, and the maker's name.
    arm : RedundantArm
        The kind of the arms.
    bases : mapping of str to Pose
        Poses of the arms' bases in the body, by side: ``left`` and ``right``.
    body : tuple of Capsule
        Space of the body.
    free_links : int
        How many links from each base are not checked against the body, which they are mounted in.
    """

    name: str
    title: str
    arm: RedundantArm
    bases: Mapping[str, Pose]
    body: tuple[Capsule, ...]
    free_links: int

    def side(self, name: str) -> NDArray[np.float64]:
        """Return the pose of an arm's base in the body (4, 4).

        Raises
        ------
        ValueError
            Where there is no such arm.
        """
        if name not in self.bases:
            raise ValueError(f"{self.title} has no arm '{name}', but {' and '.join(self.bases)}")
        return self.bases[name].matrix
