"""Puts a described model into MuJoCo's specification: bodies, joints, geoms, couplings."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import mujoco

from daidalos.description.errors import DescriptionError
from daidalos.description.joint import Joint, JointType
from daidalos.description.link import Collision, Inertial, Link, Surface
from daidalos.description.pose import Pose
from daidalos.description.world import Model
from daidalos.simulation.conversion.assets import Assets
from daidalos.simulation.conversion.contact import set_surface
from daidalos.simulation.conversion.couplings import close_loop, couple
from daidalos.simulation.conversion.geometry import add_geoms, add_rolling, only_seen
from daidalos.simulation.conversion.inertia import PrincipalInertia, principal_inertia, smallest_inertia
from daidalos.simulation.conversion.joints import add_joints, mimicked_start, start_position
from daidalos.simulation.conversion.wheels import is_caster, wheel_disc
from daidalos.simulation.errors import UnknownNameError

ASSUMED_DENSITY = 200.0
"""Of links that should move but have no mass [kg/m^3]."""


@dataclass(frozen=True)
class GeomInfo:
    """What a geom stands for."""

    link: str
    collision: str
    laser_retro: float


@dataclass(eq=False)
class ModelBuild:
    """A model while it is put together; plugins add what they need to it.

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
        MuJoCo's joints that can not start at zero, with where they do.
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
        """Return the simulation's name for a link or joint of the model."""
        return f"{self.name}::{name}"

    def add_velocity_servo(self, joint: str, gain: float, torque: float, rotor: float = 0.0) -> str:
        """Add an actuator that holds a joint's speed, and return its name.

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

    def add_position_servo(self, joint: str, stiffness: float, damping: float, effort: float) -> str:
        """Add an actuator that holds a joint's position, and return its name.

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

    def keep_awake(self) -> None:
        """Simulate the model even while it rests, since somebody measures it."""
        for body in self.trees:
            body.sleep = mujoco.mjtSleepPolicy.mjSLEEP_NEVER

    def set_inertial(self, link: str, inertial: Inertial, gravity: bool) -> None:
        """Change what a link weighs, for the next compilation."""
        _apply(self.bodies[link], principal_inertia(inertial))
        self.bodies[link].gravcomp = 0.0 if gravity else 1.0
        self.model = replace(
            self.model,
            links={**self.model.links, link: replace(self.model.links[link], inertial=inertial, gravity=gravity)},
        )

    def place_base(self, pose: Pose) -> None:
        """Put the part that does not move somewhere else, for the next compilation."""
        if self.base is not None:
            x, y, z, w = pose.orientation
            self.base.pos, self.base.quat = list(pose.position), [w, x, y, z]

    def remove(self) -> None:
        """Take the model out of the specification; what refers to its bodies goes with them."""
        for body in self.roots:
            self.spec.delete(body)
        self.roots.clear()


def add_model(
    spec: Any, assets: Assets, model: Model, name: str, pose: Pose, warn: Callable[[str], None]
) -> ModelBuild:
    """Add a model to a specification.

    Parameters
    ----------
    spec : MjSpec
    assets : Assets
        Of the same specification.
    model : Model
    name : str
        In the simulation.
    pose : Pose
        Of the model's frame in the world.
    warn : callable
        Takes a line for each thing that is left out or changed.

    Returns
    -------
    ModelBuild
        Nothing of it is left in the specification when an error is raised.
    """
    build = ModelBuild(spec, model, name)
    try:
        _Builder(build, assets, pose, warn).run()
    except Exception:
        build.remove()
        assets.release(assets.taken())
        raise
    build.assets = assets.taken()
    return build


class _Builder:
    def __init__(self, build: ModelBuild, assets: Assets, pose: Pose, warn: Callable[[str], None]) -> None:
        self._build = build
        self._model = build.model
        self._assets = assets
        self._pose = pose
        self._warn = warn
        self._above: dict[str, Joint] = {}
        for joint in self._model.joints.values():
            if joint.type is not JointType.GEARBOX:
                self._above.setdefault(joint.child, joint)
        self._below: dict[str, list[Joint]] = {}
        for joint in self._above.values():
            self._below.setdefault(joint.parent, []).append(joint)
        self._solid_without_mass: set[str] = set()
        self._empty_without_mass: set[str] = set()

    def run(self) -> None:
        self._find_weightless()
        if self._model.static:
            self._add_static()
        else:
            self._add_moving()
            self._exclude_self_collisions()
            self._couple_joints()
            if any(self._build.joints.values()) or not self._build.geoms:
                # MuJoCo judges rest by the speed of what is solid, which a joint need not move.
                self._build.keep_awake()

    # Bodies

    def _add_static(self) -> None:
        base = self._base()
        for link in self._model.links.values():
            self._add_link(base, link, link.pose)

    def _add_moving(self) -> None:
        in_world = self._below.get("world", [])
        if in_world:
            base = self._base()
            for joint in in_world:
                self._add_branch(base, joint, moves=False)
        for link in self._model.links.values():
            joint_above = self._above.get(link.name)
            if joint_above is None or joint_above.type is JointType.FLOATING:
                self._add_free(link)

    def _base(self) -> Any:
        """Add the body that a static model, or one that is fixed to the world, stands on."""
        self._build.base = self._body(self._build.spec.worldbody, self._build.name, self._pose)
        self._build.base.mocap = self._model.scripted
        self._build.roots.append(self._build.base)
        return self._build.base

    def _add_free(self, link: Link) -> None:
        world = self._build.spec.worldbody
        body = self._add_link(world, link, self._pose @ link.pose)
        self._build.roots.append(body)
        self._build.trees.append(body)
        name = f"{self._build.scoped(link.name)}::free"
        body.add_freejoint(name=name)
        self._build.free[link.name] = name
        self._add_children(link, moves=True)

    def _add_branch(self, parent: Any, joint: Joint, moves: bool) -> None:
        """Add a link and what hangs on it; `moves` tells whether its parent does."""
        if joint.type is JointType.FLOATING:
            return
        link = self._model.links[joint.child]
        body = self._add_link(parent, link, joint.origin @ joint.anchor.inverse)
        added = add_joints(body, joint, self._build.scoped(joint.name))
        self._build.joints[joint.name] = added
        for name, axis in zip(added, joint.axes, strict=False):
            if start_position(axis):
                self._build.start[name] = start_position(axis)
        if added and not moves:
            self._build.trees.append(body)
        self._add_children(link, moves or bool(added))

    def _add_children(self, link: Link, moves: bool) -> None:
        for joint in self._below.get(link.name, []):
            self._add_branch(self._build.bodies[link.name], joint, moves)

    def _add_link(self, parent: Any, link: Link, pose: Pose) -> Any:
        body = self._body(parent, self._build.scoped(link.name), pose)
        self._build.bodies[link.name] = body
        if not link.gravity:
            body.gravcomp = 1.0
        self._set_inertia(body, link)
        for index, collision in enumerate(link.collisions):
            self._add_collision(body, link, collision, index)
        if link.name in self._solid_without_mass and not body.geoms:
            _apply(body, smallest_inertia())
        return body

    def _body(self, parent: Any, name: str, pose: Pose) -> Any:
        x, y, z, w = pose.orientation
        return parent.add_body(name=name, pos=list(pose.position), quat=[w, x, y, z])

    # Mass

    def _set_inertia(self, body: Any, link: Link) -> None:
        if link.name in self._empty_without_mass:
            inertia = smallest_inertia()
        elif link.inertial is not None and link.inertial.mass > 0 and not self._model.static:
            inertia = principal_inertia(link.inertial)
        else:
            return
        if inertia.changed:
            self._warn(f"{link.where}: link {link.name!r}: {inertia.changed}")
        _apply(body, inertia)

    def _find_weightless(self) -> None:
        """Find the links that move although neither they nor what is fixed to them has any mass."""
        for link in self._model.links.values():
            above = self._above.get(link.name)
            if self._model.static or (above is not None and above.type is JointType.FIXED):
                continue
            group = self._fixed_group(link)
            if any(part.inertial is not None and part.inertial.mass > 0 for part in group):
                continue
            solid = {part.name for part in group if part.collisions}
            if solid:
                self._solid_without_mass |= solid
                self._warn(
                    f"{link.where}: link {link.name!r} moves but has no mass; "
                    f"assumed {ASSUMED_DENSITY:g} kg/m^3 for its collisions"
                )
            else:
                self._empty_without_mass.add(link.name)

    def _fixed_group(self, link: Link) -> list[Link]:
        group = [link]
        for joint in self._below.get(link.name, []):
            if joint.type is JointType.FIXED:
                group += self._fixed_group(self._model.links[joint.child])
        return group

    # Collisions

    def _add_collision(self, body: Any, link: Link, collision: Collision, index: int) -> None:
        joint = self._above.get(link.name)
        try:
            disc = wheel_disc(joint, collision)
            geoms = add_geoms(body, collision.geometry, collision.pose, self._assets, self._model.static)
            if disc is not None:
                geoms = [add_rolling(body, disc.radius, disc.width, disc.pose), *only_seen(self._build.spec, geoms)]
        except DescriptionError as problem:
            place = "" if problem.source else f"{collision.where}: "
            self._warn(f"{place}{problem}; the collision is left out")
            return
        surface = replace(collision.surface, mu=0.0, mu2=0.0) if is_caster(joint, link) else collision.surface
        for number, geom in enumerate(geoms):
            self._finish_geom(geom, link, collision, surface, f"{index}.{number}")

    def _finish_geom(self, geom: Any, link: Link, collision: Collision, surface: Surface, number: str) -> None:
        geom.name = f"{self._build.scoped(link.name)}::{number}"
        set_surface(geom, surface)
        if link.name in self._solid_without_mass:
            geom.mass, geom.density = float("nan"), ASSUMED_DENSITY
        if geom.contype:
            geom.contype = geom.conaffinity = surface.bitmask & 0x7FFFFFFF if surface.collide else 0
        name = collision.name or f"collision_{number.partition('.')[0]}"
        self._build.geoms[geom.name] = GeomInfo(link.name, name, collision.laser_retro)

    def _exclude_self_collisions(self) -> None:
        """Keep links of the model from touching each other unless both are told to."""
        solid = [link for link in self._model.links.values() if link.collisions]
        for link, other in itertools.combinations(solid, 2):
            if not (self._touches_own(link) and self._touches_own(other)):
                first, second = self._build.scoped(link.name), self._build.scoped(other.name)
                self._build.spec.add_exclude(name=f"{first}|{second}", bodyname1=first, bodyname2=second)

    def _touches_own(self, link: Link) -> bool:
        return self._model.self_collide if link.self_collide is None else link.self_collide

    # Couplings

    def _couple_joints(self) -> None:
        """Add what the tree of bodies does not hold."""
        for joint in self._model.joints.values():
            if joint.type is JointType.GEARBOX:
                self._mesh_gears(joint)
            elif self._above[joint.child] is not joint:
                self._close_loop(joint)
        for joint in self._model.joints.values():
            added = self._build.joints.get(joint.name)
            if not added:
                continue
            if joint.type is JointType.SCREW:
                couple(self._build.spec, added[1], added[0], 0.0, joint.thread_pitch)
            leader = self._build.joints.get(joint.mimic.joint) if joint.mimic else None
            if joint.mimic and leader:
                couple(self._build.spec, added[0], leader[0], joint.mimic.offset, joint.mimic.multiplier)
                self._build.start[added[0]] = mimicked_start(joint, self._model.joints)

    def _mesh_gears(self, joint: Joint) -> None:
        """Tie the joints of two gears to each other: theta_2 = -ratio * theta_1 (SDF)."""
        wheels = [self._above.get(link) for link in (joint.parent, joint.child)]
        first, second = ([] if wheel is None else self._build.joints.get(wheel.name, []) for wheel in wheels)
        if first and second:
            couple(self._build.spec, second[0], first[0], 0.0, -joint.gearbox_ratio)
        else:
            self._warn(f"{joint.where}: gearbox {joint.name!r} needs a joint on each of its gears, left out")

    def _close_loop(self, joint: Joint) -> None:
        parent = self._build.base if joint.parent == "world" else self._build.bodies[joint.parent]
        if parent is None:
            parent = self._base()
        child = self._build.bodies[joint.child]
        name = self._build.scoped(joint.name)
        self._build.joints[joint.name] = close_loop(self._build.spec, parent, child, joint, name)


def _apply(body: Any, inertia: PrincipalInertia) -> None:
    x, y, z, w = inertia.orientation
    body.explicitinertial = True
    body.mass = inertia.mass
    body.ipos = list(inertia.position)
    body.iquat = [w, x, y, z]
    body.inertia = list(inertia.moments)
