"""Values of all joints of a robot from defaults, messages, sliders and mimic joints."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from daidalos.description.joint import Joint, JointType, Mimic
from daidalos.description.robot import Robot
from daidalos.description.world import Model

_VALUED = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC)


@dataclass(frozen=True)
class JointRange:
    """Range of a joint in its `unit`, ``rad`` or ``m``; `zero` is its initial position."""

    name: str
    lower: float
    upper: float
    zero: float
    unit: str = "rad"


class JointValues:
    """Positions, velocities and efforts of a robot's joints.

    Parameters
    ----------
    robot : Robot or Model
    zeros : mapping
        Where joints begin, instead of at zero or, if that is out of reach, in the middle.
    mimics : bool
        Joints that mimic others follow them.
    dependents : mapping
        Further joints that follow others, as ``<mimic>`` would say it.
    soft : bool
        Joints stay within the soft limits of their safety controllers.

    Raises
    ------
    ValueError
        When joints follow each other in a circle.

    Attributes
    ----------
    ranges : tuple of JointRange
        Of the joints that can be set, in the order of the description.
    names : tuple of str
        Of all joints, those that follow too.
    """

    def __init__(
        self,
        robot: Robot | Model,
        zeros: Mapping[str, float] | None = None,
        mimics: bool = True,
        dependents: Mapping[str, Mimic] | None = None,
        soft: bool = True,
    ) -> None:
        joints = [joint for joint in robot.joints.values() if joint.type in _VALUED and joint.axes]
        self.names = tuple(joint.name for joint in joints)
        self._leaders = {joint.name: joint.mimic for joint in joints if mimics and joint.mimic is not None}
        self._leaders |= {name: mimic for name, mimic in (dependents or {}).items() if name in self.names}
        self.ranges = tuple(_range(joint, zeros or {}, soft) for joint in joints if joint.name not in self._leaders)
        for name in self.names:
            self._followed(name)
        self.positions = {each.name: each.zero for each in self.ranges}
        self.velocities: dict[str, float] = {}
        self.efforts: dict[str, float] = {}

    def take(
        self,
        names: Iterable[str],
        positions: Iterable[float] = (),
        velocities: Iterable[float] = (),
        efforts: Iterable[float] = (),
    ) -> None:
        """Set the named joints, ignoring unknown names; a short series sets the first ones."""
        known = set(self.names)
        names = list(names)
        pairs = ((self.positions, positions), (self.velocities, velocities), (self.efforts, efforts))
        for target, values in pairs:
            target.update((name, value) for name, value in zip(names, values, strict=False) if name in known)

    def position(self, name: str) -> float:
        """Return the position of a joint; that of a mimic joint follows from its leader."""
        leader, factor, offset = self._followed(name)
        return factor * self.positions.get(leader, 0.0) + offset

    def all_positions(self) -> list[float]:
        """Return the positions of all joints in the order of `names`."""
        return [self.position(name) for name in self.names]

    def all_velocities(self) -> list[float]:
        """Return the velocities of all joints in the order of `names`; unset ones are zero."""
        followed = map(self._followed, self.names)
        return [factor * self.velocities.get(leader, 0.0) for leader, factor, _ in followed]

    def all_efforts(self) -> list[float]:
        """Return the efforts of all joints in the order of `names`; mimic joints have their leader's, as in ROS."""
        return [self.efforts.get(self._followed(name)[0], 0.0) for name in self.names]

    def _followed(self, name: str) -> tuple[str, float, float]:
        """Return the joint at the end of a chain of mimic joints, with the factor and the offset to it."""
        seen: set[str] = set()
        factor, offset = 1.0, 0.0
        while name in self._leaders:
            if name in seen:
                raise ValueError(f"Found an infinite recursive mimic chain: {', '.join(sorted(seen))}")
            seen.add(name)
            mimic = self._leaders[name]
            factor, offset, name = factor * mimic.multiplier, offset + factor * mimic.offset, mimic.joint
        return name, factor, offset


def _range(joint: Joint, zeros: Mapping[str, float], soft: bool) -> JointRange:
    axis = joint.axis
    lower, upper = (-math.pi, math.pi) if joint.type is JointType.CONTINUOUS else (axis.lower, axis.upper)
    safety = joint.safety
    # Both are zero when the file gives none.
    if soft and safety is not None and safety.soft_lower_limit < safety.soft_upper_limit:
        lower, upper = max(lower, safety.soft_lower_limit), min(upper, safety.soft_upper_limit)
    middle = (lower + upper) / 2 if math.isfinite(lower + upper) else 0.0
    zero = zeros.get(joint.name, 0.0 if lower <= 0.0 <= upper else middle)
    unit = "m" if joint.type is JointType.PRISMATIC else "rad"
    return JointRange(joint.name, lower, upper, zero, unit)
