"""gz's systems that apply forces: efforts on joints, and thrusters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from daidalos.common.pose3 import rotate
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import NumberCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.topics import absolute_topic


class ApplyJointForce(Plugin):
    """gz's ApplyJointForce system: applies the last received effort to a joint."""

    names = ("gz-sim-apply-joint-force-system",)
    state: float

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.joint = self.parameters.require_joint("joint_name")
        default = f"/model/{context.model_name}/joint/{self.joint}/cmd_force"
        self.topic = absolute_topic(description.element.text_of("topic", default=default), context.namespace)

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the effort."""
        return {self.topic: Subscription(NumberCommand, self._command)}

    def prepare(self, build: ModelBuild) -> None:
        """Add a motor."""
        self._motor = build.add_motor(self.joint)

    def bind(self, instance: Instance) -> None:
        """Find the motor."""
        self._data = instance.physics.data
        self._control = instance.actuator(self._motor)

    def start(self) -> float:
        """Return a zero effort."""
        return 0.0

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply the effort."""
        self._data.ctrl[self._control] = self.state
        return ()

    def _command(self, command: NumberCommand) -> None:
        self.state = command.value


class Thruster(Plugin):
    """gz's Thruster system: a propeller with a thrust along its joint's axis.

    The thrust is coefficient x density x diameter^4 x speed |speed|; commands are thrusts [N], or speeds
    [rad/s] with ``use_angvel_cmd``. The propeller itself does not turn.
    """

    names = ("gz-sim-thruster-system",)
    unused = ("velocity_control", "p_gain", "i_gain", "d_gain", "wake_fraction", "alpha_1", "alpha_2")
    state: float

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.joint = self.parameters.require_joint("joint_name")
        diameter = element.number_of("propeller_diameter", default=0.02)
        self.factor = element.number_of("thrust_coefficient", default=1.0) * diameter**4
        self.factor *= element.number_of("fluid_density", default=1000.0)
        self.limits = (
            element.number_of("min_thrust_cmd", default=-1000.0),
            element.number_of("max_thrust_cmd", default=1000.0),
        )
        if self.limits[0] > self.limits[1]:
            raise element.error("<min_thrust_cmd> is above <max_thrust_cmd>")
        self.takes_speeds = element.flag_of("use_angvel_cmd", default=False)
        word = "cmd_vel" if self.takes_speeds else "cmd_thrust"
        namespace = element.text_of("namespace", default=context.model_name)
        own = element.text_of("topic")
        name = f"/model/{namespace}/{own}" if own else f"/model/{namespace}/joint/{self.joint}/{word}"
        self.topic = absolute_topic(name, context.namespace)
        self._key = f"{context.model_name}::{description.name}"

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the thrust or speed."""
        return {self.topic: Subscription(NumberCommand, self._command)}

    def bind(self, instance: Instance) -> None:
        """Find the propeller."""
        joint = instance.model.joints[self.joint]
        self._forces = instance.physics.forces
        self._link = instance.link(joint.child)
        self._axis = np.array(rotate(joint.anchor.orientation, joint.axis.xyz))

    def start(self) -> float:
        """Return a zero thrust."""
        return 0.0

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Apply the thrust at the propeller's centre of mass."""
        self._forces.hold(self._key, self._link.body, self._link.rotation @ self._axis * self.state, np.zeros(3))
        return ()

    def _command(self, command: NumberCommand) -> None:
        value = command.value
        thrust = self.factor * value * abs(value) if self.takes_speeds else value
        self.state = min(max(thrust, self.limits[0]), self.limits[1])
