"""Friction along a single direction for mecanum wheels: SDF's ``<fdir1>`` in a frame that does not roll."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.description.link import Surface
from daidalos.description.world import Model
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import Component, ComponentContext
from daidalos.simulation.conversion.contact import MAX_FRICTION, friction_of, set_friction
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.last_step import cross, velocities


class DirectionalFriction(Component):
    """Friction of links along a direction of another link.

    MuJoCo's contacts rub the same in all directions, so they keep the smaller coefficient. The rest is a force
    against the slip of the contact along the direction, up to Coulomb's limit. It is as stiff as a step can
    integrate when it follows from the step before: bringing everything up to date in each step would take longer
    than the step itself.

    Parameters
    ----------
    context : ComponentContext
        Its model has the surfaces.
    """

    def __init__(self, context: ComponentContext) -> None:
        super().__init__(context)
        self._surfaces = directed_surfaces(context.model)

    def prepare(self, build: ModelBuild) -> None:
        """Set the smaller friction coefficient on the contacts."""
        for name, info in build.geoms.items():
            surface = self._surfaces.get(info.link)
            if surface is not None:
                least = min(_pair(surface))
                set_friction(build.spec.geom(name), replace(surface, mu=least, mu2=least))

    def bind(self, instance: Instance) -> None:
        """Find the links and their effective masses."""
        self._instance = instance
        compiled = instance.physics.model
        self._keys = [f"{instance.name}::{name}/friction" for name in self._surfaces]
        self._bodies = np.array([instance.link(name).body for name in self._surfaces], dtype=np.intp)
        surfaces = self._surfaces.values()
        self._frames = np.array([instance.link(one.direction_frame).body for one in surfaces], dtype=np.intp)
        self._directions = np.array([one.direction for one in surfaces])
        pairs = np.array([_pair(one) for one in surfaces])
        self._turned, self._friction = pairs[:, 0] < pairs[:, 1], np.abs(pairs[:, 0] - pairs[:, 1])
        self._share = len(self._bodies) / compiled.body_subtreemass[compiled.body_rootid[self._bodies]]
        joints = {joint.child: joint.name for joint in instance.model.joints.values()}
        moving = [
            instance.joint(joints[n]) if instance.build.joints.get(joints.get(n, "")) else None for n in self._surfaces
        ]
        self._moments = compiled.body_inertia[self._bodies].max(axis=1)
        self._moments += [0.0 if one is None else compiled.dof_armature[one.dof] for one in moving]
        rows = {name: row for row, name in enumerate(self._surfaces)}
        self._row_of = np.full(compiled.ngeom, -1)
        for geom, (model, info) in instance.physics.geoms.items():
            if model == instance.name:
                self._row_of[geom] = rows.get(info.link, -1)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply forces against the slip of each link in contact."""
        physics = self._instance.physics
        points, normals, loads = self._touching()
        grips = self._friction_forces(points, normals, loads)
        arms = points - physics.data.xipos[self._bodies]
        torques = cross(arms, grips)
        for row, key in enumerate(self._keys):
            if loads[row] > 0:
                physics.forces.hold(key, int(self._bodies[row]), grips[row], torques[row])
            else:
                physics.forces.release(key)
        return ()

    def _touching(self) -> tuple[Array, Array, Array]:
        """Return the mean position (n, 3) of each link's contacts, their normals (n, 3) and normal forces (n,) [N]."""
        data = self._instance.physics.data
        contact = data.contact
        rows = self._row_of[contact.geom].max(axis=1, initial=-1)
        chosen = np.flatnonzero((rows >= 0) & (contact.efc_address >= 0))
        rows, count = rows[chosen], len(self._keys)
        # The first number of a contact with an elliptic cone is the force along its normal.
        weights = data.efc_force[contact.efc_address[chosen]]
        loads = np.bincount(rows, weights, count).astype(np.float64)
        sums = np.zeros((count, 6))
        np.add.at(sums, rows, weights[:, None] * np.hstack((contact.pos[chosen], contact.frame[chosen, :3])))
        sums /= np.where(loads > 0, loads, 1.0)[:, None]
        return sums[:, :3], sums[:, 3:], loads

    def _friction_forces(self, points: Array, normals: Array, loads: Array) -> Array:
        """Return the forces (n, 3) against the slip at contacts."""
        model, data = self._instance.physics.model, self._instance.physics.data
        directions = np.einsum("nij,nj->ni", data.xmat[self._frames].reshape(-1, 3, 3), self._directions)
        directions = np.where(self._turned[:, None], cross(normals, directions), directions)
        directions -= np.sum(directions * normals, axis=1)[:, None] * normals
        directions /= np.maximum(np.linalg.norm(directions, axis=1), 1e-9)[:, None]
        arms = points - data.xpos[self._bodies]
        linear, angular = velocities(self._instance.physics, self._bodies)
        slips = np.sum((linear + cross(angular, arms)) * directions, axis=1)
        masses = 1 / (self._share + np.sum(arms * arms, axis=1) / self._moments)
        most = self._friction * loads
        grips: Array = directions * np.clip(-0.5 * masses / model.opt.timestep * slips, -most, most)[:, None]
        return grips


def directed_surfaces(model: Model) -> dict[str, Surface]:
    """Return the surfaces with a friction direction in another link, by link."""
    found = {}
    for link in model.links.values():
        for surface in (collision.surface for collision in link.collisions if any(collision.surface.direction)):
            frame = _frame(model, link.name, surface.direction_frame)
            if frame and len(set(_pair(surface))) > 1:
                found[link.name] = replace(surface, direction_frame=frame)
    return found


def _frame(model: Model, link: str, frame: str) -> str:
    """Return the link of a frame name, for a link that may be in a nested model; empty for none."""
    scope = link.rpartition("::")[0]
    if frame == "__model__":
        return next(name for name in model.links if name.rpartition("::")[0] == scope)
    scoped = f"{scope}::{frame}" if scope else frame
    return next((name for name in (scoped, frame) if name in model.links), "")


def _pair(surface: Surface) -> tuple[float, float]:
    """Return the friction coefficients along the direction and across it."""
    along, across = (friction_of(replace(surface, mu=value, mu2=value)) for value in (surface.mu, surface.mu2))
    return min(along, MAX_FRICTION), min(across, MAX_FRICTION)
