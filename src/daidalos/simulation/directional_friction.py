"""Friction along one direction alone, as mecanum wheels have it: SDF's ``<fdir1>`` in a frame that does not roll."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.description.link import Surface
from daidalos.description.world import Model
from daidalos.simulation.component import Component, Setting
from daidalos.simulation.conversion.contact import MAX_FRICTION, friction_of, set_friction
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance, LinkView
from daidalos.simulation.samples import Sample

Array = NDArray[np.float64]


class DirectionalFriction(Component):
    """Holds links against slipping along a direction of another link.

    MuJoCo's contacts rub the same in all directions, so they keep the smaller coefficient. The rest is a force
    against the slip of the contact along the direction, up to Coulomb's limit. It is as stiff as a step can
    integrate.

    Parameters
    ----------
    setting : Setting
        Its model has the surfaces.
    """

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self._surfaces = directed_surfaces(setting.model)

    def prepare(self, build: ModelBuild) -> None:
        """Leave the smaller friction to the contacts."""
        for name, info in build.geoms.items():
            surface = self._surfaces.get(info.link)
            if surface is not None:
                least = min(_pair(surface))
                set_friction(build.spec.geom(name), replace(surface, mu=least, mu2=least))

    def bind(self, instance: Instance) -> None:
        """Find the links, and how stiff their grip may be."""
        self._instance = instance
        self._links = {name: instance.link(name) for name in self._surfaces}
        self._frames = {name: instance.link(one.direction_frame) for name, one in self._surfaces.items()}
        self._owner = {
            geom: info.link
            for geom, (model, info) in instance.physics.geoms.items()
            if model == instance.name and info.link in self._links
        }
        joints = {joint.child: joint.name for joint in instance.model.joints.values()}
        compiled = instance.physics.model
        self._moments = {}
        for name, link in self._links.items():
            self._moments[name] = float(compiled.body_inertia[link.body].max())
            if instance.build.joints.get(joints.get(name, "")):
                self._moments[name] += float(compiled.dof_armature[instance.joint(joints[name]).dof])

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Push each link that touches something against its slip."""
        forces = self._instance.physics.forces
        touching = self._touching()
        for name, link in self._links.items():
            key = f"{self._instance.name}::{name}/friction"
            if name in touching:
                point, normal, load = touching[name]
                force = self._force(name, point, normal, load)
                arm = point - self._instance.physics.data.xipos[link.body]
                forces.hold(key, link.body, force, np.cross(arm, force))
            else:
                forces.release(key)
        return ()

    def _touching(self) -> dict[str, tuple[Array, Array, float]]:
        """Return the middle of each link's contacts, their normal and the force in it [N]."""
        physics = self._instance.physics
        physics.refresh()
        model, data = physics.model, physics.data
        pairs = data.contact.geom
        mine = np.flatnonzero(np.isin(pairs, list(self._owner)).any(axis=1))
        sums: dict[str, tuple[Array, Array, float]] = {}
        wrench = np.zeros(6)
        for row in mine:
            contact = data.contact[row]
            first, second = (int(geom) for geom in pairs[row])
            name = self._owner.get(first) or self._owner[second]
            mujoco.mj_contactForce(model, data, row, wrench)
            point, normal, load = sums.get(name, (np.zeros(3), np.zeros(3), 0.0))
            weight = max(float(wrench[0]), 1e-9)
            sums[name] = (point + weight * contact.pos, normal + weight * contact.frame[:3], load + weight)
        return {name: (point / load, normal / load, load) for name, (point, normal, load) in sums.items()}

    def _force(self, name: str, point: Array, normal: Array, load: float) -> Array:
        surface, link, frame = self._surfaces[name], self._links[name], self._frames[name]
        along, across = _pair(surface)
        direction = frame.rotation @ np.array(surface.direction)
        if along < across:
            direction = np.cross(normal, direction)
        direction = direction - (direction @ normal) * normal
        length = float(np.linalg.norm(direction))
        if length < 1e-6:
            return np.zeros(3)
        direction /= length
        linear, angular = link.velocity()
        slip = float((linear + np.cross(angular, point - np.array(link.pose.position))) @ direction)
        most = abs(along - across) * load
        force: Array = direction * min(max(-self._stiffness(name, link, point) * slip, -most), most)
        return force

    def _stiffness(self, name: str, link: LinkView, point: Array) -> float:
        model = self._instance.physics.model
        mass = float(model.body_subtreemass[model.body_rootid[link.body]])
        reach = float(np.linalg.norm(point - np.array(link.pose.position)))
        share = 1 / (len(self._links) / mass + reach**2 / self._moments[name])
        return 0.5 * share / float(model.opt.timestep)


def directed_surfaces(model: Model) -> dict[str, Surface]:
    """Return the surfaces that rub differently along a direction of another link, by the link that has them."""
    found = {}
    for link in model.links.values():
        for surface in (collision.surface for collision in link.collisions if any(collision.surface.direction)):
            frame = _frame(model, link.name, surface.direction_frame)
            if frame and len(set(_pair(surface))) > 1:
                found[link.name] = replace(surface, direction_frame=frame)
    return found


def _frame(model: Model, link: str, frame: str) -> str:
    """Return the link whose axes a frame means, for a link that may be in a nested model; empty for none."""
    scope = link.rpartition("::")[0]
    if frame == "__model__":
        return next(name for name in model.links if name.rpartition("::")[0] == scope)
    scoped = f"{scope}::{frame}" if scope else frame
    return next((name for name in (scoped, frame) if name in model.links), "")


def _pair(surface: Surface) -> tuple[float, float]:
    """Return the coefficients along the direction and across it."""
    along, across = (friction_of(replace(surface, mu=value, mu2=value)) for value in (surface.mu, surface.mu2))
    return min(along, MAX_FRICTION), min(across, MAX_FRICTION)
