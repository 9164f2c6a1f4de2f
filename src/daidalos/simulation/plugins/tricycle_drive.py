"""Tricycle drive: one driven and steered wheel, and two wheels with encoders."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import move_along_arc
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import TwistCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.odometry import transform_of, wheel_odometry
from daidalos.samples.sensors import (
    JointStateSample,
    OdometrySample,
    Sample,
    TransformSample,
)
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.truth import link_transforms
from daidalos.simulation.topics import frame

_SERVO_TIME = 0.01
"""Time constant of the wheel's servo [s]."""

_STEERING_BANDWIDTH = 60.0
"""Bandwidth of the steering servo [rad/s]."""


@dataclass
class Motion:
    """Command, speed and angle of the driven wheel, and the odometry."""

    command: Array
    speed: float
    angle: float
    turns: Array
    pose: Array
    stamp_ns: int = -1


class TricycleDrive(Plugin):
    """``libgazebo_ros_tricycle_drive.so``: the command's angular z is the steering angle."""

    names = ("gazebo_ros_tricycle_drive",)
    unused = ("wheel_speed_tolerance", "steering_angle_tolerance", "odometry_source")
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, p = description.element, self.parameters
        self.steering, self.driven = (
            self.parameters.require_joint("steering_joint"),
            self.parameters.require_joint("actuated_wheel_joint"),
        )
        self.encoders = (
            self.parameters.require_joint("encoder_wheel_left_joint"),
            self.parameters.require_joint("encoder_wheel_right_joint"),
        )
        self.separation = self._positive("wheel_separation", 0.34)
        self.driven_radius = self._positive("actuated_wheel_diameter", 0.15) / 2
        self.encoder_radius = self._positive("encoder_wheel_diameter", 0.15) / 2
        self.torque = self._positive("max_wheel_torque", 5.0)
        self.acceleration = element.number_of("max_wheel_acceleration", default=0.0) or math.inf
        self.steering_speed = element.number_of("max_steering_speed", default=0.0) or math.inf
        self.most = element.number_of("max_steering_angle", default=math.pi / 2)
        rate = element.number_of("update_rate", default=100.0)
        self.period = 1.0 / rate if rate > 0 else 0.0
        self.topic = p.topic(element.text_of("command_topic", default="cmd_vel"))
        odometry = p.topic(element.text_of("odometry_topic", default="odom"))
        self.odometry_topic = odometry if element.flag_of("publish_odom", default=True) else ""
        self.tf_topic = p.topic("/tf") if element.flag_of("publish_odom_tf", default=True) else ""
        self.wheel_topic = p.topic("/tf") if element.flag_of("publish_wheel_tf", default=False) else ""
        states = element.flag_of("publish_wheel_joint_state", default=False)
        self.state_topic = p.topic("joint_states") if states else ""
        self.odometry_frame = frame(element.text_of("odometry_frame", default="odom"))
        self.base_frame = frame(element.text_of("robot_base_frame", default="base_footprint"))

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry, transforms and joint states, if enabled."""
        topics: dict[str, type[Sample]] = {
            self.odometry_topic: OdometrySample,
            self.tf_topic or self.wheel_topic: TransformSample,
            self.state_topic: JointStateSample,
        }
        return {topic: kind for topic, kind in topics.items() if topic}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded speed and steering angle."""
        return {self.topic: Subscription(TwistCommand, self._command)}

    def prepare(self, build: ModelBuild) -> None:
        """Add a velocity servo to the wheel and a position servo to its steering joint."""
        mass = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        driven = mass * self.driven_radius**2
        self._drive_servo = build.add_velocity_servo(self.driven, 2 * driven / _SERVO_TIME, self.torque, rotor=driven)
        moment = max(0.02 * mass * self.driven_radius**2, 1e-4)
        build.spec.joint(build.joints[self.steering][0]).armature = moment
        gains = moment * _STEERING_BANDWIDTH**2, 2 * moment * _STEERING_BANDWIDTH
        self._steering_servo = build.add_position_servo(self.steering, *gains, math.inf)

    def bind(self, instance: Instance) -> None:
        """Find servos, wheels and base."""
        self._instance = instance
        self._controls = instance.actuator(self._drive_servo), instance.actuator(self._steering_servo)
        self._moved = [instance.joint(name) for name in (self.steering, self.driven, *self.encoders)]
        base = self.base_frame.rpartition("/")[2]
        base = base if base in instance.build.bodies else next(iter(instance.build.bodies))
        self._base = instance.link(base)
        joints = instance.model.joints
        self._shown = [joint.name for joint in self._moved if joints[joint.name].child != base]

    def start(self) -> Motion:
        """Return the state at rest."""
        return Motion(np.zeros(2), 0.0, 0.0, self._turns(), np.zeros(3))

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Measure the wheels, then drive and steer."""
        motion = self.state
        step = self.period or self._instance.physics.model.opt.timestep
        elapsed = step if motion.stamp_ns < 0 else (now_ns - motion.stamp_ns) * 1e-9
        motion.stamp_ns = now_ns
        odometry = self._odometry(now_ns, elapsed)
        self._drive(elapsed)
        if self.odometry_topic:
            yield odometry
        if self.tf_topic:
            yield transform_of(odometry, self.tf_topic)
        if self.wheel_topic:
            told = self._instance, self._base, self._shown, now_ns, self.wheel_topic, self.base_frame
            yield from link_transforms(*told)
        if self.state_topic:
            yield self._joint_states(now_ns)

    def _command(self, command: TwistCommand) -> None:
        angle = min(max(float(command.angular[2]), -self.most), self.most)
        self.state.command = np.array((float(command.linear[0]), angle))

    def _drive(self, elapsed: float) -> None:
        motion = self.state
        speed, angle = motion.command.tolist()
        motion.speed = _nearer(motion.speed, speed, self.acceleration * elapsed)
        motion.angle = _nearer(motion.angle, angle, self.steering_speed * elapsed)
        self._instance.physics.data.ctrl[list(self._controls)] = motion.speed / self.driven_radius, motion.angle

    def _odometry(self, now_ns: int, elapsed: float) -> OdometrySample:
        motion = self.state
        turns = self._turns()
        left, right = ((turns - motion.turns) * self.encoder_radius).tolist()
        motion.turns = turns
        forward, turn = (left + right) / 2, (right - left) / self.separation
        motion.pose = move_along_arc(motion.pose, forward, turn)
        frames = self.odometry_frame, self.base_frame
        velocity = forward / elapsed, 0.0, turn / elapsed
        return wheel_odometry(now_ns, self.odometry_topic, frames, motion.pose, velocity)

    def _joint_states(self, now_ns: int) -> JointStateSample:
        return JointStateSample(
            stamp_ns=now_ns,
            topic=self.state_topic,
            frame_id="",
            names=tuple(joint.name for joint in self._moved),
            positions=np.array([joint.position for joint in self._moved]),
            velocities=np.array([joint.velocity for joint in self._moved]),
            efforts=np.array([joint.effort for joint in self._moved]),
        )

    def _turns(self) -> Array:
        return np.array([joint.position for joint in self._moved[2:]])

    def _positive(self, tag: str, default: float) -> float:
        value = self.parameters.element.number_of(tag, default=default)
        if value <= 0:
            raise self.parameters.element.error(f"<{tag}> should be positive, got {value:g}")
        return value


def _nearer(value: float, goal: float, reach: float) -> float:
    """Return the value, moved towards the goal by at most `reach`."""
    return value + min(max(goal - value, -reach), reach)
