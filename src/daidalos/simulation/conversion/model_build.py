"""Model under construction, with the names by which the simulation finds its parts."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import mujoco

from daidalos.common.pose3 import Pose
from daidalos.description.link import Inertial, Surface
from daidalos.description.world import Model
from daidalos.simulation.conversion.contact import set_friction
from daidalos.simulation.conversion.couplings import SOLIMP, SOLREF
from daidalos.simulation.conversion.inertia import PrincipalInertia, principal_inertia
from daidalos.simulation.errors import UnknownNameError


@dataclass(frozen=True)
class GeomInfo:
    """Link and collision of a geom."""

    link: str
    collision: str
    laser_retro: float


@dataclass(eq=False)
class ModelBuild:
    """Model under construction, to which plugins can add.

    Attributes
    ----------
    spec : MjSpec
    model : Model
    name : str
        The model's name in the simulation.
    bodies : dict
        Link to body (MjsBody).
    roots : list
        Bodies to delete when the model goes.
    joints : dict
        Joint to the names of MuJoCo's joints.
    start : dict
        MuJoCo's joints that cannot start at zero, with where they do.
    free : dict
        Link to the name of its free joint.
    base : MjsBody or None
        What does not move of the model, in the world.
    trees : list
        Bodies that move by themselves, with all that hangs on them.
    geoms : dict
        Name of a geom to what it stands for.
    assets : tuple of str
        Meshes to release when the model goes.
    """

    spec: Any
    model: Model
    name: str
    bodies: dict[str, Any] = field(default_factory=dict)
    roots: list[Any] = field(default_factory=list)
    joints: dict[str, list[str]] = field(default_factory=dict)
    start: dict[str, float] = field(default_factory=dict)
    free: dict[str, str] = field(default_factory=dict)
    base: Any = None
    trees: list[Any] = field(default_factory=list)
    geoms: dict[str, GeomInfo] = field(default_factory=dict)
    assets: tuple[str, ...] = ()

    def scoped(self, name: str) -> str:
        """Return the name of a link or joint of the model in the simulation."""
        return f"{self.name}::{name}"

    def add_velocity_servo(self, joint: str, gain: float, torque: float, rotor: float = 0.0) -> str:
        """Add an actuator that controls a joint's velocity, and return its name.

        Parameters
        ----------
        joint : str
        gain : float
            Torque per error of speed [N m s/rad].
        torque : float
            Largest torque [N m]; infinite for no limit.
        rotor : float
            Inertia of the motor's rotor, seen from the joint [kg m^2]. The contact solver does not know
            of the implicit part of a servo: without a rotor as heavy as what a wheel drives, the wheel
            would slip while the speed changes.
        """
        if not self.joints.get(joint):
            raise UnknownNameError("movable joint", joint, [n for n, added in self.joints.items() if added])
        self.spec.joint(self.joints[joint][0]).armature = rotor
        actuator = self.spec.add_actuator(
            name=f"{self.scoped(joint)}::velocity",
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            target=self.joints[joint][0],
        )
        actuator.set_to_velocity(kv=gain)
        if torque != float("inf"):
            actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
            actuator.forcerange = [-torque, torque]
        return str(actuator.name)

    def add_motor(self, joint: str) -> str:
        """Add an actuator that applies an effort to a joint, and return its name."""
        if not self.joints.get(joint):
            raise UnknownNameError("movable joint", joint, [n for n, added in self.joints.items() if added])
        actuator = self.spec.add_actuator(
            name=f"{self.scoped(joint)}::effort",
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            target=self.joints[joint][0],
        )
        actuator.set_to_motor()
        return str(actuator.name)

    def add_position_servo(self, joint: str, stiffness: float, damping: float, effort: float) -> str:
        """Add an actuator that controls a joint's position, and return its name.

        Parameters
        ----------
        joint : str
        stiffness, damping : float
            Effort per error of position and of speed.
        effort : float
            The largest; infinite for no limit.
        """
        if not self.joints.get(joint):
            raise UnknownNameError("movable joint", joint, [n for n, added in self.joints.items() if added])
        actuator = self.spec.add_actuator(
            name=f"{self.scoped(joint)}::position",
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            target=self.joints[joint][0],
        )
        actuator.set_to_position(kp=stiffness, kv=damping)
        if effort != float("inf"):
            actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
            actuator.forcerange = [-effort, effort]
        return str(actuator.name)

    def add_weld(self, link: str, key: str) -> str:
        """Add an inactive weld of a link, whose other body is set while the world runs, and return its name."""
        weld = self.spec.add_equality(
            name=f"{self.scoped(link)}::{key}::weld",
            type=mujoco.mjtEq.mjEQ_WELD,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            name1=self.scoped(link),
            name2="world",
            active=False,
        )
        weld.solref[:2], weld.solimp[:2] = SOLREF, SOLIMP
        return str(weld.name)

    def keep_awake(self) -> None:
        """Disable sleeping of the model."""
        for body in self.trees:
            body.sleep = mujoco.mjtSleepPolicy.mjSLEEP_NEVER

    def set_inertial(self, link: str, inertial: Inertial, gravity: bool) -> None:
        """Change a link's mass properties for the next compilation."""
        apply_inertia(self.bodies[link], principal_inertia(inertial))
        self.bodies[link].gravcomp = 0.0 if gravity else 1.0
        self.model = replace(
            self.model,
            links={**self.model.links, link: replace(self.model.links[link], inertial=inertial, gravity=gravity)},
        )

    def set_joint(self, joint: str, damping: float | None, limits: tuple[float, float] | None) -> None:
        """Change a joint's damping and limits for the next compilation; None keeps them."""
        described = self.spec.joint(self.joints[joint][0])
        if damping is not None:
            described.damping = [damping, 0.0, 0.0]
        if limits is not None:
            described.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            described.range = sorted(limits)

    def set_friction(self, friction: float, link: str | None) -> None:
        """Change the friction of the collisions of one link, or of all, for the next compilation."""
        surface = Surface(mu=friction, mu2=friction)
        for name, info in self.geoms.items():
            if link is None or info.link == link:
                set_friction(self.spec.geom(name), surface)

    def place_base(self, pose: Pose) -> None:
        """Move the static part of the model, for the next compilation."""
        if self.base is not None:
            x, y, z, w = pose.orientation
            self.base.pos, self.base.quat = list(pose.position), [w, x, y, z]

    def remove(self) -> None:
        """Remove the model from the specification, with everything that refers to its bodies."""
        for body in self.roots:
            self.spec.delete(body)
        self.roots.clear()


def apply_inertia(body: Any, inertia: PrincipalInertia) -> None:
    """Set mass and inertia of a body (MjsBody)."""
    x, y, z, w = inertia.orientation
    body.explicitinertial = True
    body.mass = inertia.mass
    body.ipos = list(inertia.position)
    body.iquat = [w, x, y, z]
    body.inertia = list(inertia.moments)
