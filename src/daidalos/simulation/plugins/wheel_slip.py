"""Wheel slip: wheels that creep in proportion to their contact force."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import rotate
from daidalos.description.geometry import Cylinder, Sphere
from daidalos.description.link import Link, Surface
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.samples.sensors import Sample, WheelSlipSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.contact import DEFAULT_FRICTION, set_friction
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.instance import Instance
from daidalos.simulation.last_step import cross, velocities

_UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Wheel:
    """Wheel with slip.

    Parameters
    ----------
    link, joint : str
    radius : float
        [m].
    lateral, longitudinal : float
        Slip compliances: slip speed over rim speed, for each tangential over normal force.
    normal_force : float
        [N].
    friction : float
        The largest tangential over normal force.
    """

    link: str
    joint: str
    radius: float
    lateral: float
    longitudinal: float
    normal_force: float
    friction: float


class WheelSlip(Plugin):
    """``libWheelSlipPlugin.so``, ``libgazebo_ros_wheel_slip.so`` and gz's WheelSlip system.

    The wheels lose their friction in the physics; the plugin puts in its place a force against the slip of
    the contact point, v N / (c |r w|), as ODE's ``slip1`` and ``slip2`` do. Where that would be stiffer than
    a step can integrate it is held below.
    """

    names = ("WheelSlipPlugin", "gazebo_ros_wheel_slip", "gz-sim-wheel-slip-system")
    sample = WheelSlipSample

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.wheels = [self._wheel(child) for child in description.element.all("wheel")]
        self.topic = self.parameters.topic(description.element.text_of("topic", default="wheel_slip"))
        self._key = f"{context.model_name}::{description.name}"

    def prepare(self, build: ModelBuild) -> None:
        """Remove the wheels' contact friction."""
        slipping = {wheel.link for wheel in self.wheels}
        for name, info in build.geoms.items():
            if info.link in slipping:
                set_friction(build.spec.geom(name), Surface(mu=0.0, mu2=0.0))

    def bind(self, instance: Instance) -> None:
        """Find the wheels, and the stability limits of their forces."""
        self._instance = instance
        model, wheels = instance.physics.model, self.wheels
        self._bodies = np.array([instance.link(wheel.link).body for wheel in wheels], dtype=np.intp)
        self._dofs = np.array([instance.joint(wheel.joint).dof for wheel in wheels], dtype=np.intp)
        joints = [instance.model.joints[wheel.joint] for wheel in wheels]
        axes = [rotate(joint.anchor.orientation, joint.axis.xyz) for joint in joints]
        self._axes = np.array(axes).reshape(-1, 3)
        self._radii = np.array([wheel.radius for wheel in wheels])
        self._compliances = np.array([(w.lateral / w.normal_force, w.longitudinal / w.normal_force) for w in wheels])
        self._max_force = np.array([wheel.friction * wheel.normal_force for wheel in wheels])
        moments = model.dof_armature[self._dofs] + model.body_inertia[self._bodies].max(axis=1)
        masses = model.body_subtreemass[model.body_rootid[self._bodies]]
        self._limits = 0.5 / (len(wheels) / masses + self._radii**2 / moments) / model.opt.timestep

    def start(self) -> int:
        """Return the time of the first report, at once."""
        return 0

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply friction forces to each wheel in contact."""
        if not self.wheels:
            return
        physics = self._instance.physics
        touching = np.isin(self._bodies, physics.model.geom_bodyid[physics.data.contact.geom.ravel()])
        linear, angular = velocities(physics, self._bodies)
        slips, ahead = self._slips(linear, angular)
        rims = physics.data.qvel[self._dofs] * self._radii
        grips = self._friction_forces(slips, rims)
        forces = grips[:, :1] * _left_of(ahead) + grips[:, 1:] * ahead
        arms = physics.data.xpos[self._bodies] + self._below - physics.data.xipos[self._bodies]
        torques = cross(arms, forces)
        for row, wheel in enumerate(self.wheels):
            key = f"{self._key}/{wheel.link}"
            if touching[row]:
                physics.forces.hold(key, int(self._bodies[row]), forces[row], torques[row])
            else:
                physics.forces.release(key)
        if now_ns >= self.state:
            self.state = now_ns + 100_000_000
            names = tuple(wheel.link for wheel in self.wheels)
            shares = np.where(touching[:, None], _shares(slips, rims, linear), 0.0)
            yield WheelSlipSample(now_ns, self.topic, "", names, shares[:, 0], shares[:, 1])

    @property
    def _below(self) -> Array:
        """Vectors from the wheels' centres to the ground (n, 3)."""
        return np.outer(-self._radii, _UP)

    def _slips(self, linear: Array, angular: Array) -> tuple[Array, Array]:
        """Return lateral and longitudinal slip velocities (n, 2) of contacts, and their forward directions (n, 3)."""
        turns = self._instance.physics.data.xmat[self._bodies].reshape(-1, 3, 3)
        axes = np.einsum("nij,nj->ni", turns, self._axes)
        ahead = cross(axes, np.tile(_UP, (len(axes), 1)))
        ahead /= np.maximum(np.linalg.norm(ahead, axis=1), 1e-9)[:, None]
        patches = linear + cross(angular, self._below)
        return np.stack([np.sum(patches * way, axis=1) for way in (_left_of(ahead), ahead)], axis=1), ahead

    def _friction_forces(self, slips: Array, rims: Array) -> Array:
        """Return the lateral and longitudinal friction forces (n, 2) of contacts."""
        compliances = self._compliances * np.maximum(np.abs(rims), 1e-3)[:, None]
        grips = -slips * np.minimum(1 / np.maximum(compliances, 1e-9), self._limits[:, None])
        scale = np.minimum(1.0, self._max_force / np.maximum(np.linalg.norm(grips, axis=1), 1e-9))
        held: Array = grips * scale[:, None]
        return held

    def _wheel(self, element: Element) -> Wheel:
        model = self.context.model
        link = self.context.require_link(self.parameters.scoped(element.attribute("link_name")), element)
        joint = next((joint for joint in model.joints.values() if joint.child == link), None)
        if joint is None:
            raise AbsentPartError(f"link_name is {link!r}, expected a link that a joint holds", element)
        force, radius = element.number_of("wheel_normal_force", default=0.0), _radius(model.links[link], element)
        if not force > 0:
            raise element.error("<wheel_normal_force> should be positive")
        frictions = [c.surface.mu for c in model.links[link].collisions if c.surface.mu is not None]
        return Wheel(
            link=link,
            joint=self.context.require_joint(joint.name, element),
            radius=radius,
            lateral=element.number_of("slip_compliance_lateral", default=1.0),
            longitudinal=element.number_of("slip_compliance_longitudinal", default=1.0),
            normal_force=force,
            friction=frictions[0] if frictions else DEFAULT_FRICTION,
        )


def _left_of(ahead: Array) -> Array:
    """Return the direction to the left of directions (n, 3) in the plane."""
    return np.stack((-ahead[:, 1], ahead[:, 0], np.zeros(len(ahead))), axis=1)


def _shares(slips: Array, rims: Array, linear: Array) -> Array:
    """Return (n, 2): the angle between the wheel and its motion, and its longitudinal slip ratio."""
    speeds = np.linalg.norm(linear, axis=1)
    angles = np.arcsin(np.clip(slips[:, 0] / np.maximum(speeds, 1e-3), -1.0, 1.0))
    moving, turning = speeds > 1e-3, np.abs(rims) > 1e-3
    shares = np.abs(slips[:, 1]) / np.maximum(np.abs(rims), 1e-3)
    return np.stack((np.where(moving, angles, 0.0), np.where(turning, shares, 0.0)), axis=1)


def _radius(link: Link, element: Element) -> float:
    """Return the radius from the parameters, or from the shape."""
    given = element.number_of("wheel_radius", default=0.0)
    round_shapes = [c.geometry for c in link.collisions if isinstance(c.geometry, Cylinder | Sphere)]
    if not given and not round_shapes:
        raise element.error("<wheel_radius> is needed, since the wheel is neither cylinder nor sphere")
    return given or round_shapes[0].radius
