"""Planar move: a base that moves over the ground with the commanded velocity; gz's velocity control."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import TwistCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.odometry import transform_of
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.truth import true_odometry
from daidalos.simulation.topics import absolute_topic, frame


@dataclass
class Motion:
    """Commanded velocity, origin of the odometry, and time of the next publication."""

    linear: Array
    angular: Array
    origin: Pose
    due_ns: int = 0


class PlanarMove(Plugin):
    """``libgazebo_ros_planar_move.so`` of ROS 1 and 2."""

    names = ("gazebo_ros_planar_move",)
    unused = ("update_rate",)
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, parameters = description.element, self.parameters
        self.command_topic = parameters.topic(element.text_of("commandTopic", "command_topic", default="cmd_vel"))
        self.odometry_topic = parameters.topic(element.text_of("odometryTopic", "odometry_topic", default="odom"))
        self.odometry_frame = frame(element.text_of("odometryFrame", "odometry_frame", default="odom"))
        self.base_frame = frame(element.text_of("robotBaseFrame", "robot_base_frame", default="base_footprint"))
        self.publishes = element.flag_of("publish_odom", default=True)
        self.publishes_tf = element.flag_of("publish_odom_tf", "broadcastTF", default=True)
        self.covariance = (
            element.number_of("covariance_x", default=1e-5),
            element.number_of("covariance_y", default=1e-5),
            element.number_of("covariance_yaw", default=1e-3),
        )
        rate = element.number_of("odometryRate", "publish_rate", default=20.0)
        self._publish_ns = round(1e9 / rate) if rate > 0 else 0

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry and its transform, if enabled."""
        topics: dict[str, type[Sample]] = {self.odometry_topic: OdometrySample} if self.publishes else {}
        return topics | ({"/tf": TransformSample} if self.publishes_tf else {})

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded velocity."""
        return {self.command_topic: Subscription(TwistCommand, self._command)}

    def bind(self, instance: Instance) -> None:
        """Find the base."""
        self._instance = instance
        base = self.parameters.scoped(self.base_frame)
        self._base = instance.link(base if base in instance.build.bodies else next(iter(instance.build.bodies)))

    def start(self) -> Motion:
        """Return the state at rest."""
        return Motion(np.zeros(3), np.zeros(3), self._base.pose)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Set the planar velocity of the base; it may fall and tilt freely."""
        motion = self.state
        self._move()
        if now_ns < motion.due_ns:
            return
        motion.due_ns = now_ns + self._publish_ns
        topic = self.odometry_topic
        frames = self.odometry_frame, self.base_frame
        odometry = true_odometry(self._base, now_ns, topic, *frames, self.covariance, motion.origin)
        if self.publishes:
            yield odometry
        if self.publishes_tf:
            yield transform_of(odometry, "/tf")

    def _command(self, command: TwistCommand) -> None:
        self.state.linear, self.state.angular = np.array(command.linear), np.array(command.angular)

    def _move(self) -> None:
        motion = self.state
        linear, angular = self._base.velocity()
        yaw = self._base.pose.yaw
        ahead = np.array(((np.cos(yaw), -np.sin(yaw)), (np.sin(yaw), np.cos(yaw))))
        wanted = np.array((*(ahead @ motion.linear[:2]), linear[2]))
        self._instance.set_velocity(wanted, np.array((angular[0], angular[1], motion.angular[2])))
        self._instance.physics.changed()


class VelocityControl(Plugin):
    """gz's VelocityControl system: the model moves with the commanded velocity in its own axes."""

    names = ("gz-sim-velocity-control-system",)
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        topic = element.text_of("topic", default=f"/model/{context.model_name}/cmd_vel")
        self.topic = absolute_topic(topic, context.namespace)
        self._linear = element.vector_of("initial_linear", size=3, default=(0.0, 0.0, 0.0))
        self._angular = element.vector_of("initial_angular", size=3, default=(0.0, 0.0, 0.0))

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded velocity."""
        return {self.topic: Subscription(TwistCommand, self._command)}

    def bind(self, instance: Instance) -> None:
        """Find the first link."""
        self._instance = instance
        self._base = instance.link(next(iter(instance.build.bodies)))

    def start(self) -> Motion:
        """Return the initial velocity of the description."""
        return Motion(np.array(self._linear), np.array(self._angular), self._base.pose)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Set the velocity of the model."""
        turn = rotation_matrix(self._base.pose.orientation)
        self._instance.set_velocity(turn @ self.state.linear, turn @ self.state.angular)
        self._instance.physics.changed()
        return ()

    def _command(self, command: TwistCommand) -> None:
        self.state.linear, self.state.angular = np.array(command.linear), np.array(command.angular)
