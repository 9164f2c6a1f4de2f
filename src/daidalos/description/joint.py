"""Joints of URDF and SDF."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.link import Sensor


class JointType(StrEnum):
    """Joint types of URDF (the first six) and those that SDF adds."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FIXED = "fixed"
    FLOATING = "floating"
    PLANAR = "planar"
    BALL = "ball"
    UNIVERSAL = "universal"
    REVOLUTE2 = "revolute2"
    SCREW = "screw"
    GEARBOX = "gearbox"


@dataclass(frozen=True)
class Axis:
    """Axis of motion; lengths in metres, angles in radians.

    Parameters
    ----------
    xyz : tuple of 3 floats
        Unit vector in the joint's frame; for a planar joint the plane's normal.
    lower, upper : float
        Position limits; infinite when there are none.
    effort, velocity : float
        Largest force or torque [N, N m] and speed [m/s, rad/s]; infinite when there are none.
    damping, friction : float
        Viscous [N s/m, N m s/rad] and dry [N, N m].
    spring_stiffness, spring_reference : float
        A spring towards a position.
    """

    xyz: Vector = (1.0, 0.0, 0.0)
    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    velocity: float = math.inf
    damping: float = 0.0
    friction: float = 0.0
    spring_stiffness: float = 0.0
    spring_reference: float = 0.0


@dataclass(frozen=True)
class Mimic:
    """Mimic joint: position = multiplier * position of the other joint + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Safety:
    """URDF's ``<safety_controller>``: soft limits inside the hard ones."""

    k_velocity: float
    k_position: float = 0.0
    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0


@dataclass(frozen=True)
class Calibration:
    """URDF's ``<calibration>``: positions of the reference edges."""

    rising: float | None = None
    falling: float | None = None


@dataclass(frozen=True)
class Joint:
    """Joint between two links.

    At position q the child's pose in its parent is ``origin @ motion(q) @ anchor.inverse``.

    Parameters
    ----------
    name : str
    type : JointType
    parent, child : str
        Names of links; `parent` may be ``world``.
    origin : Pose
        The joint's frame in the parent link.
    anchor : Pose
        The joint's frame in the child link; identity in URDF.
    axes : tuple of Axis
        One for most types, two for universal, revolute2 and gearbox, none for fixed, floating and ball.
    mimic : Mimic or None
    safety : Safety or None
    calibration : Calibration or None
    thread_pitch : float
        Metres that a screw joint advances per radian.
    gearbox_ratio, gearbox_reference : float, str
        As SDF has them.
    sensors : tuple of Sensor
        Force-torque sensors on the joint.
    where : str
        The place in the description, for errors.
    """

    name: str
    type: JointType
    parent: str
    child: str
    origin: Pose = field(default_factory=Pose)
    anchor: Pose = field(default_factory=Pose)
    axes: tuple[Axis, ...] = ()
    mimic: Mimic | None = None
    safety: Safety | None = None
    calibration: Calibration | None = None
    thread_pitch: float = 0.0
    gearbox_ratio: float = 1.0
    gearbox_reference: str = ""
    sensors: tuple[Sensor, ...] = ()
    where: str = field(default="", compare=False)

    @property
    def axis(self) -> Axis:
        """First axis; a neutral one for joints without axes."""
        return self.axes[0] if self.axes else Axis()
