"""Wheel slip: wheels that creep in proportion to the force that they carry."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.description.geometry import Cylinder, Sphere
from daidalos.description.link import Link, Surface
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.description.pose import rotate
from daidalos.simulation.component import Setting
from daidalos.simulation.conversion.contact import DEFAULT_FRICTION, set_friction
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance, JointView, LinkView
from daidalos.simulation.plugins.base import Plugin
from daidalos.simulation.samples import Sample, WheelSlipSample

Array = NDArray[np.float64]

_UP = np.array((0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Wheel:
    """A wheel that slips.

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

    def __init__(self, description: Description, setting: Setting) -> None:
        super().__init__(description, setting)
        self.wheels = [self._wheel(child) for child in description.element.all("wheel")]
        self.topic = self.parameters.topic(description.element.text_of("topic", default="wheel_slip"))
        self._key = f"{setting.model_name}::{description.name}"

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """The slip of all wheels."""
        return {self.topic: WheelSlipSample}

    def prepare(self, build: ModelBuild) -> None:
        """Take the wheels' friction away."""
        slipping = {wheel.link for wheel in self.wheels}
        for name, info in build.geoms.items():
            if info.link in slipping:
                set_friction(build.spec.geom(name), Surface(mu=0.0, mu2=0.0))

    def bind(self, instance: Instance) -> None:
        """Find the wheels, and how stiff their grip may be."""
        self._instance = instance
        self._views: list[tuple[Wheel, LinkView, JointView]] = [
            (wheel, instance.link(wheel.link), instance.joint(wheel.joint)) for wheel in self.wheels
        ]
        model = instance.physics.model
        mass = float(model.body_subtreemass[model.body_rootid[self._views[0][1].body]]) if self._views else 0.0
        self._limits = []
        for wheel, link, joint in self._views:
            moment = float(model.dof_armature[joint.dof] + model.body_inertia[link.body].max())
            share = 1 / (len(self._views) / mass + wheel.radius**2 / moment)
            self._limits.append(0.5 * share / model.opt.timestep)

    def start(self) -> int:
        """Report at once."""
        return 0

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Hold each wheel that touches against its slip."""
        touching = self._touching()
        shares = np.zeros((len(self._views), 2))
        for row, (wheel, link, joint) in enumerate(self._views):
            if link.body in touching:
                slip = self._grip(wheel, link, joint, self._limits[row])
                shares[row] = _shares(slip, joint.velocity * wheel.radius, link)
            else:
                self._instance.physics.forces.release(f"{self._key}/{wheel.link}")
        if now_ns >= self.memory:
            self.memory = now_ns + 100_000_000
            names = tuple(wheel.link for wheel in self.wheels)
            yield WheelSlipSample(now_ns, self.topic, "", names, shares[:, 0], shares[:, 1])

    def _grip(self, wheel: Wheel, link: LinkView, joint: JointView, limit: float) -> Array:
        """Push against a wheel's slip; return its slip speeds to the side and ahead."""
        data = self._instance.physics.data
        linear, angular = link.velocity()
        below = np.array((0.0, 0.0, -wheel.radius))
        patch = linear + np.cross(angular, below)
        axis = np.array(rotate(link.pose.orientation, self.setting.model.joints[wheel.joint].axis.xyz))
        ahead = np.cross(axis, _UP)
        ahead /= max(float(np.linalg.norm(ahead)), 1e-9)
        slips = np.array((float(patch @ np.cross(_UP, ahead)), float(patch @ ahead)))
        rim = abs(joint.velocity) * wheel.radius
        compliances = np.array((wheel.lateral, wheel.longitudinal)) * max(rim, 1e-3) / wheel.normal_force
        grips = -slips * np.minimum(1 / np.maximum(compliances, 1e-9), limit)
        most = wheel.friction * wheel.normal_force
        grips *= min(1.0, most / max(float(np.linalg.norm(grips)), 1e-9))
        force = grips[0] * np.cross(_UP, ahead) + grips[1] * ahead
        arm = np.array(link.pose.position) + below - data.xipos[link.body]
        self._instance.physics.forces.hold(f"{self._key}/{wheel.link}", link.body, force, np.cross(arm, force))
        return slips

    def _touching(self) -> set[int]:
        physics = self._instance.physics
        physics.refresh_positions()
        return set(physics.model.geom_bodyid[physics.data.contact.geom.ravel()].tolist())

    def _wheel(self, element: Element) -> Wheel:
        model = self.setting.model
        link = self.parameters.scoped(element.attribute("link_name"))
        joint = next((joint for joint in model.joints.values() if joint.child == link), None)
        if joint is None:
            raise element.error(f"link_name is {link!r}, expected a link that a joint holds")
        force, radius = element.number_of("wheel_normal_force", default=0.0), _radius(model.links[link], element)
        if not force > 0:
            raise element.error("<wheel_normal_force> should be positive")
        frictions = [c.surface.mu for c in model.links[link].collisions if c.surface.mu is not None]
        return Wheel(
            link=link,
            joint=joint.name,
            radius=radius,
            lateral=element.number_of("slip_compliance_lateral", default=1.0),
            longitudinal=element.number_of("slip_compliance_longitudinal", default=1.0),
            normal_force=force,
            friction=frictions[0] if frictions else DEFAULT_FRICTION,
        )


def _shares(slip: Array, rim: float, link: LinkView) -> Array:
    """Return the angle between where a wheel points and where it goes, and its slip as a share of its speed."""
    speed = float(np.linalg.norm(link.velocity()[0]))
    angle = math.asin(min(max(float(slip[0]) / speed, -1.0), 1.0)) if speed > 1e-3 else 0.0
    return np.array((angle, abs(float(slip[1])) / abs(rim) if abs(rim) > 1e-3 else 0.0))


def _radius(link: Link, element: Element) -> float:
    """Return what the parameters say, or the shape."""
    given = element.number_of("wheel_radius", default=0.0)
    round_shapes = [c.geometry for c in link.collisions if isinstance(c.geometry, Cylinder | Sphere)]
    if not given and not round_shapes:
        raise element.error("<wheel_radius> is needed, since the wheel is neither cylinder nor sphere")
    return given or round_shapes[0].radius
