"""Force-torque sensor in a joint."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.markup import Element
from daidalos.samples.sensors import Sample, WrenchSample
from daidalos.simulation.instance import Instance
from daidalos.simulation.noise import Noise
from daidalos.simulation.sensors.noisy import NoisySensor, noise_of_axes

_FRAMES = ("child", "parent", "sensor")


class ForceTorque(NoisySensor):
    """Sensor of the force [N] and the torque [N m] between a joint's two links.

    Attributes
    ----------
    frame : str
        ``child``, ``parent`` or ``sensor``: whose axes the numbers are in.
    from_child : bool
        What the child does to its parent, rather than the other way round.
    """

    names = ("force_torque",)
    default_topic = "forcetorque"
    sample = WrenchSample

    def read(self, element: Element) -> None:
        """Read frame, direction and noise."""
        settings = element.first("force_torque") or Element("force_torque")
        self.frame = settings.text_of("frame", default="child")
        if self.frame not in _FRAMES:
            raise settings.error(f"<frame> is {self.frame!r}, expected one of {', '.join(_FRAMES)}")
        self.from_child = settings.text_of("measure_direction", default="child_to_parent") != "parent_to_child"
        self._noises: tuple[Noise, ...] = (
            *noise_of_axes(settings.first("force")),
            *noise_of_axes(settings.first("torque")),
        )

    def set_noise(self, noise: Noise) -> None:
        """Set the same noise on all six values."""
        self._noises = (noise,) * 6

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of force and torque."""
        return self._noises

    def bind(self, instance: Instance) -> None:
        """Find the joint, or the parent joint of the link."""
        super().bind(instance)
        joints = self.context.model.joints
        above = (joint for joint in joints.values() if joint.child == self.link_name)
        self._joint = joints.get(self.joint_name) or next(above, None)
        parent = None if self._joint is None else self._joint.parent
        self._parent = instance.link(parent) if parent in instance.build.bodies else None

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the wrench between the links."""
        physics = self.instance.physics
        physics.refresh_loads()
        model, data = physics.model, physics.data
        # MuJoCo keeps torque and force on the child at the centre of mass of the whole tree, in world axes.
        torque, force = data.cfrc_int[self.link.body, :3], data.cfrc_int[self.link.body, 3:]
        anchor = self.link.pose @ (Pose() if self._joint is None else self._joint.anchor)
        centre = data.subtree_com[model.body_rootid[self.link.body]]
        torque = torque + np.cross(centre - np.array(anchor.position), force)
        turn = rotation_matrix(self._axes().orientation).T * (-1.0 if self.from_child else 1.0)
        measured = self.apply_noise(np.concatenate((turn @ force, turn @ torque)), now_ns)
        yield WrenchSample(now_ns, self.topic, self.frame_id, measured[:3], measured[3:])

    def _axes(self) -> Pose:
        if self.frame == "parent" and self._parent is not None:
            return self._parent.pose
        return self.link.pose @ self.pose if self.frame == "sensor" else self.link.pose
