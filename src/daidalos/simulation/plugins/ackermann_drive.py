"""Ackermann drive: steered front wheels that share their turning centre with the driven wheels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import move_along_arc
from daidalos.description.geometry import Cylinder, Sphere
from daidalos.description.link import Plugin as Description
from daidalos.description.world import Model
from daidalos.samples.commands import NumberCommand, TwistCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.odometry import transform_of, wheel_odometry
from daidalos.samples.sensors import (
    NumberSample,
    OdometrySample,
    Sample,
    TransformSample,
)
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.ackermann_settings import Settings, read_settings
from daidalos.simulation.plugins.truth import link_transforms, true_odometry

_SERVO_TIME = 0.01
"""Time constant of the wheel servos [s]."""

_STEERING_BANDWIDTH = 60.0
"""Bandwidth of the steering servos [rad/s]."""


@dataclass
class Motion:
    """Current command, speed and steering, and the odometry."""

    command: Array
    speed: float
    steering: float
    angles: Array
    pose: Array
    place: Array
    distance: float = 0.0
    stamp_ns: int = -1


class AckermannDrive(Plugin):
    """ROS 2's ``libgazebo_ros_ackermann_drive.so`` and gz's AckermannSteering system."""

    names = ("gazebo_ros_ackermann_drive", "gz-sim-ackermann-steering-system")
    unused = tuple(
        f"{what}_{gain}"
        for what in ("left_steering", "right_steering", "linear_velocity")
        for gain in ("pid_gain", "i_range")
    )
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.settings = _measured(read_settings(self.parameters, context), context.model)
        self.period = self.settings.period

    def prepare(self, build: ModelBuild) -> None:
        """Add velocity servos to the wheels and position servos to the steering joints."""
        s = self.settings
        mass = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        wheels = [joint for joint in (*s.left, *s.right) if joint]
        driven = mass * s.wheel_radius**2 / max(len(wheels), 1)
        infinite = float("inf")
        self._wheel_servos = [
            build.add_velocity_servo(joint, 2 * driven / _SERVO_TIME, infinite, rotor=driven) for joint in wheels
        ]
        moment = max(0.02 * mass * s.wheel_radius**2, 1e-4)
        gains = moment * _STEERING_BANDWIDTH**2, 2 * moment * _STEERING_BANDWIDTH
        steered = [joint for joint in (s.left_steering, s.right_steering, s.steering_wheel) if joint]
        for joint in steered:
            build.spec.joint(build.joints[joint][0]).armature = moment
        self._steering_servos = [build.add_position_servo(joint, *gains, infinite) for joint in steered]

    def bind(self, instance: Instance) -> None:
        """Find servos, wheels and base."""
        s = self.settings
        self._instance = instance
        self._drives = [instance.actuator(servo) for servo in self._wheel_servos]
        self._steers = [instance.actuator(servo) for servo in self._steering_servos]
        self._wheels = [instance.joint(joint) for joint in (*s.left, *s.right)]
        base = s.base_frame.rpartition("/")[2]
        self._base = instance.link(base if base in instance.build.bodies else next(iter(instance.build.bodies)))

    def start(self) -> Motion:
        """Return the state at rest."""
        return Motion(np.zeros(2), 0.0, 0.0, self._angles(), np.zeros(3), self._place())

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry and its transform, if enabled."""
        topics: dict[str, type[Sample]] = {
            self.settings.odometry_topic: OdometrySample,
            self.settings.tf_topic or ("/tf" if self.settings.publish_wheels else ""): TransformSample,
            self.settings.distance_topic: NumberSample,
        }
        return {topic: kind for topic, kind in topics.items() if topic}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded velocity, or of the steering angle."""
        if self.settings.steers_only:
            return {self.settings.command_topic: Subscription(NumberCommand, self._command_angle)}
        return {self.settings.command_topic: Subscription(TwistCommand, self._command)}

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Measure, then drive and steer."""
        s, motion = self.settings, self.state
        step = self.period or self._instance.physics.model.opt.timestep
        elapsed = step if motion.stamp_ns < 0 else (now_ns - motion.stamp_ns) * 1e-9
        motion.stamp_ns = now_ns
        odometry = None if s.steers_only else self._odometry(now_ns, elapsed)
        self._drive(elapsed)
        if odometry is None:
            return
        if s.odometry_topic:
            yield odometry
        if s.tf_topic:
            yield transform_of(odometry, s.tf_topic)
        if s.publish_wheels:
            joints = [*s.left, *s.right, *filter(None, (s.left_steering, s.right_steering, s.steering_wheel))]
            topic = s.tf_topic or "/tf"
            yield from link_transforms(self._instance, self._base, joints, now_ns, topic, s.base_frame)
        if s.distance_topic:
            place = self._place()
            motion.distance += float(np.linalg.norm(place - motion.place))
            motion.place = place
            yield NumberSample(now_ns, s.distance_topic, "", motion.distance)

    def _command(self, command: TwistCommand) -> None:
        self.state.command = np.array((float(command.linear[0]), float(command.angular[2])))

    def _command_angle(self, command: NumberCommand) -> None:
        self.state.command = np.array((0.0, command.value))

    def _drive(self, elapsed: float) -> None:
        s, motion = self.settings, self.state
        speed, turn = motion.command.tolist()
        motion.speed = s.linear.apply(speed, motion.speed, elapsed)
        if s.steers_only:
            steering = turn
        elif s.steers_by_angle:
            steering = math.copysign(turn, turn * speed) if speed else turn
        else:
            steering = math.atan(turn * s.wheel_base / speed) if speed else 0.0
        motion.steering = min(max(steering, -s.steering_limit), s.steering_limit)
        slope = math.tan(motion.steering)
        curvature = slope / s.wheel_base
        left = math.atan2(slope, 1 - curvature * s.track / 2)
        right = math.atan2(slope, 1 + curvature * s.track / 2)
        ctrl = self._instance.physics.data.ctrl
        ctrl[self._steers] = (left, right, motion.steering * s.steering_wheel_ratio)[: len(self._steers)]
        if self._drives:
            ctrl[self._drives] = motion.speed / s.wheel_radius * self._factors(curvature)

    def _factors(self, curvature: float) -> Array:
        """Return each wheel's speed relative to the base in a curve; steered wheels travel the longer way."""
        s = self.settings
        factors = []
        for side, joints in ((1.0, s.left), (-1.0, s.right)):
            inner = 1 - side * curvature * s.rear_track / 2
            for number in range(len(joints)):
                is_front = s.steers_by_angle and number == 0
                factors.append(math.hypot(inner, curvature * s.wheel_base) if is_front else inner)
        return np.array(factors)

    def _odometry(self, now_ns: int, elapsed: float) -> OdometrySample:
        s, motion = self.settings, self.state
        if s.truth:
            return true_odometry(self._base, now_ns, s.odometry_topic, s.odometry_frame, s.base_frame)
        angles = self._angles()
        travel = (angles - motion.angles) * s.wheel_radius
        motion.angles = angles
        half = len(s.left)
        left, right = float(travel[:half].mean()), float(travel[half:].mean())
        forward, turn = (left + right) / 2, (right - left) / s.rear_track
        motion.pose = move_along_arc(motion.pose, forward, turn)
        frames = s.odometry_frame, s.base_frame
        return wheel_odometry(now_ns, s.odometry_topic, frames, motion.pose, (forward / elapsed, 0.0, turn / elapsed))

    def _place(self) -> Array:
        return np.array(self._base.pose.position[:2])

    def _angles(self) -> Array:
        return np.array([wheel.position for wheel in self._wheels])


def _measured(settings: Settings, model: Model) -> Settings:
    """Return the settings with missing values measured from the model: radius, wheel base and tracks."""
    if settings.steers_only:
        return settings
    joints = model.joints

    def place(joint: str) -> Array:
        return np.array(model.links[joints[joint].child].pose.position)

    radius = settings.wheel_radius or _radius(model, joints[settings.left[-1]].child)
    front = (place(settings.left_steering) + place(settings.right_steering)) / 2
    rear = (place(settings.left[-1]) + place(settings.right[-1])) / 2
    return replace(
        settings,
        wheel_radius=radius,
        wheel_base=settings.wheel_base or float(np.linalg.norm((front - rear)[:2])),
        track=settings.track
        or float(np.linalg.norm((place(settings.left_steering) - place(settings.right_steering))[:2])),
        rear_track=settings.rear_track
        or float(np.linalg.norm((place(settings.left[-1]) - place(settings.right[-1]))[:2])),
    )


def _radius(model: Model, link: str) -> float:
    for collision in model.links[link].collisions:
        if isinstance(collision.geometry, Cylinder | Sphere):
            return collision.geometry.radius
    return 0.3
