"""Mimic joint plugin of Gazebo classic, such as for the fingers of grippers."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.description.link import Plugin as Description
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.couplings import couple
from daidalos.simulation.conversion.model_build import ModelBuild


class MimicJoint(Plugin):
    """``libroboticsgroup_gazebo_mimic_joint_plugin.so`` and its variants; joints with ``<mimic>`` follow without it."""

    names = (
        *("gazebo_mimic_joint_plugin", "gazebo_mimic_joint", "roboticsgroup_gazebo_mimic_joint_plugin"),
        "roboticsgroup_upatras_gazebo_mimic_joint_plugin",
    )
    unused = ("hasPID", "maxEffort", "sensitiveness", "namespace", "robotNamespace")

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.leader, self.follower = self.parameters.require_joint("joint"), self.parameters.require_joint("mimicJoint")
        self.multiplier = description.element.number_of("multiplier", default=1.0)
        self.offset = description.element.number_of("offset", default=0.0)

    def prepare(self, build: ModelBuild) -> None:
        """Couple the joints."""
        follower, leader = build.joints.get(self.follower), build.joints.get(self.leader)
        if follower and leader and self.context.model.joints[self.follower].mimic is None:
            couple(build.spec, follower[0], leader[0], self.offset, self.multiplier)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Do nothing; the coupling is part of the physics."""
        return ()
