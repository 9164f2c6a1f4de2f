"""Force plugin: applies the last received wrench to a link."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from daidalos.common.pose3 import rotation_matrix
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import WrenchCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.instance import Instance


class Force(Plugin):
    """``libgazebo_ros_force.so`` of ROS 1 and 2."""

    names = ("gazebo_ros_force",)
    state: WrenchCommand

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.link = self.parameters.require_link("bodyName", "body_name", "link_name")
        self.topic = self.parameters.topic(element.text_of("topicName", "topic_name", default="gazebo_ros_force"))
        self.follows = element.text_of("force_frame", default="world") in ("link", "body")
        self._key = f"{context.model_name}::{description.name}"

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the wrench."""
        return {self.topic: Subscription(WrenchCommand, self._command)}

    def bind(self, instance: Instance) -> None:
        """Find the link."""
        self._forces = instance.physics.forces
        self._link = instance.link(self.link)

    def start(self) -> WrenchCommand:
        """Return a zero wrench."""
        return WrenchCommand()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply the wrench at the centre of mass."""
        turn = rotation_matrix(self._link.pose.orientation) if self.follows else np.eye(3)
        self._forces.hold(self._key, self._link.body, turn @ self.state.force, turn @ self.state.torque)
        return ()

    def _command(self, command: WrenchCommand) -> None:
        self.state = command
