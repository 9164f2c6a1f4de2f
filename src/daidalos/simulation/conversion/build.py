"""Conversion of a model to MuJoCo's specification: bodies, joints, geoms and couplings."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from daidalos.common.pose3 import Pose
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Heightmap, Mesh, Plane
from daidalos.description.joint import Joint, JointType
from daidalos.description.link import Collision, Link, Surface
from daidalos.description.world import Model
from daidalos.simulation.conversion.assets import Assets
from daidalos.simulation.conversion.contact import set_surface
from daidalos.simulation.conversion.couplings import close_loop, couple
from daidalos.simulation.conversion.geometry import add_geoms, add_rolling, only_seen
from daidalos.simulation.conversion.inertia import min_inertia, principal_inertia
from daidalos.simulation.conversion.joints import add_joints, mimicked_start, start_position
from daidalos.simulation.conversion.model_build import GeomInfo, ModelBuild, apply_inertia
from daidalos.simulation.conversion.wheels import is_caster, wheel_disc

ASSUMED_DENSITY = 200.0
"""Density of moving links without mass [kg/m^3]."""


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
        Called with a line for each thing that is left out or changed.

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
            taken = joint.type is JointType.GEARBOX or joint.child in self._above or self._is_static(joint.child)
            if not taken and not self._closes_loop(joint):
                self._above[joint.child] = joint
        self._below: dict[str, list[Joint]] = {}
        for joint in self._above.values():
            self._below.setdefault(joint.parent, []).append(joint)
        self._free = [link for link in self._model.links.values() if self._is_free(link)]
        self._held = [link for link in self._free if link.static or _has_plane(link)]
        self._solid_without_mass: set[str] = set()
        self._empty_without_mass: set[str] = set()

    def _closes_loop(self, joint: Joint) -> bool:
        """Return whether a joint's parent hangs on its child already."""
        link: str | None = joint.parent
        while link is not None and link != joint.child:
            link = self._above[link].parent if link in self._above else None
        return link == joint.child

    def _is_static(self, link: str) -> bool:
        """Return whether a link does not move, whatever pushes; the world is such a one."""
        return link == "world" or self._model.links[link].static

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
        if in_world or self._held:
            base = self._base()
            self._add_branches([(base, joint, False) for joint in in_world])
            for link in self._held:
                if not link.static:
                    self._warn(f"{link.where}: link {link.name!r} stays where it is, as an infinite plane cannot move")
                self._add_link(base, link, link.pose)
                self._add_children(link, moves=False)
        for link in self._free:
            if link not in self._held:
                self._add_free(link)

    def _is_free(self, link: Link) -> bool:
        joint_above = self._above.get(link.name)
        return joint_above is None or joint_above.type is JointType.FLOATING

    def _base(self) -> Any:
        """Add the root body of a static model or of one that is fixed to the world."""
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

    def _add_branches(self, branches: list[tuple[Any, Joint, bool]]) -> None:
        """Add the links at joints and their descendants; each joint comes with its parent body and whether that moves.

        Each link is followed by what hangs on it. Arms may have any number of links: this does not recur.
        """
        waiting = branches[::-1]
        while waiting:
            parent, joint, moves = waiting.pop()
            if joint.type is not JointType.FLOATING:
                body, moves = self._add_branch(parent, joint, moves)
                waiting += [(body, below, moves) for below in reversed(self._below.get(joint.child, []))]

    def _add_branch(self, parent: Any, joint: Joint, moves: bool) -> tuple[Any, bool]:
        """Add the link at a joint; return its body and whether it moves."""
        link = self._model.links[joint.child]
        body = self._add_link(parent, link, joint.origin @ joint.anchor.inverse)
        added = add_joints(body, joint, self._build.scoped(joint.name))
        self._build.joints[joint.name] = added
        for name, axis in zip(added, joint.axes, strict=False):
            if start_position(axis):
                self._build.start[name] = start_position(axis)
        if added and not moves:
            self._build.trees.append(body)
        return body, moves or bool(added)

    def _add_children(self, link: Link, moves: bool) -> None:
        body = self._build.bodies[link.name]
        self._add_branches([(body, joint, moves) for joint in self._below.get(link.name, [])])

    def _add_link(self, parent: Any, link: Link, pose: Pose) -> Any:
        body = self._body(parent, self._build.scoped(link.name), pose)
        self._build.bodies[link.name] = body
        if not link.gravity:
            body.gravcomp = 1.0
        self._set_inertia(body, link)
        for index, collision in enumerate(link.collisions):
            self._add_collision(body, link, collision, index)
        self._warn_of_unseen(link)
        if link.name in self._solid_without_mass and not body.geoms:
            apply_inertia(body, min_inertia())
        return body

    def _warn_of_unseen(self, link: Link) -> None:
        """Warn of missing files of visuals at once, since no camera may ever render them."""
        for visual in link.visuals:
            shape = visual.geometry
            if isinstance(shape, Mesh | Heightmap) and shape.path is None:
                kind = type(shape).__name__.lower()
                self._warn(f"{shape.where}: {kind} {shape.uri} not found; the visual is not drawn")

    def _body(self, parent: Any, name: str, pose: Pose) -> Any:
        x, y, z, w = pose.orientation
        return parent.add_body(name=name, pos=list(pose.position), quat=[w, x, y, z])

    # Mass

    def _set_inertia(self, body: Any, link: Link) -> None:
        if link.name in self._empty_without_mass:
            inertia = min_inertia()
        elif link.inertial is not None and link.inertial.mass > 0 and not self._model.static:
            inertia = principal_inertia(link.inertial)
        else:
            return
        if inertia.changed:
            self._warn(f"{link.where}: link {link.name!r}: {inertia.changed}")
        apply_inertia(body, inertia)

    def _find_weightless(self) -> None:
        """Find moving links without mass, including everything fixed to them."""
        for link in self._model.links.values():
            above = self._above.get(link.name)
            if self._model.static or link in self._held or (above is not None and above.type is JointType.FIXED):
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
        """Return a link with all links fixed to it, directly or indirectly."""
        group = [link]
        for member in group:
            below = self._below.get(member.name, [])
            group += [self._model.links[joint.child] for joint in below if joint.type is JointType.FIXED]
        return group

    # Collisions

    def _add_collision(self, body: Any, link: Link, collision: Collision, index: int) -> None:
        joint = self._above.get(link.name)
        try:
            disc = wheel_disc(joint, collision)
            geoms = add_geoms(body, collision.geometry, collision.pose, self._assets, self._model.static or link.static)
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
        """Exclude contacts between links of the model unless both enable self-collision."""
        solid = [link for link in self._model.links.values() if link.collisions]
        for link, other in itertools.combinations(solid, 2):
            if not (self._touches_own(link) and self._touches_own(other)):
                first, second = self._build.scoped(link.name), self._build.scoped(other.name)
                self._build.spec.add_exclude(name=f"{first}|{second}", bodyname1=first, bodyname2=second)

    def _touches_own(self, link: Link) -> bool:
        return self._model.self_collide if link.self_collide is None else link.self_collide

    # Couplings

    def _couple_joints(self) -> None:
        """Add the couplings that the tree of bodies does not represent."""
        for joint in self._model.joints.values():
            if joint.type is JointType.GEARBOX:
                self._mesh_gears(joint)
            elif self._above.get(joint.child) is not joint and not (
                self._is_static(joint.parent) and self._is_static(joint.child)
            ):
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
        """Couple the joints of two gears: theta_2 = -ratio * theta_1 (SDF)."""
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


def _has_plane(link: Link) -> bool:
    return any(isinstance(collision.geometry, Plane) for collision in link.collisions)
