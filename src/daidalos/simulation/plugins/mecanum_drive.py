"""Mecanum drive: velocities of four mecanum wheels from a commanded velocity, odometry from the wheels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose2 import move_along_arc
from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import TwistCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.odometry import transform_of, wheel_odometry
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.diff_drive import SERVO_TIME
from daidalos.simulation.plugins.diff_drive_settings import Limits
from daidalos.simulation.topics import absolute_topic, frame

_WHEELS = ("front_left_joint", "front_right_joint", "back_left_joint", "back_right_joint")
_MIX = np.array([(1.0, -1.0, -1.0), (1.0, 1.0, 1.0), (1.0, 1.0, -1.0), (1.0, -1.0, 1.0)])
"""Rim speed of each wheel for a speed ahead, one to the left, and a turn rate times the arm."""


@dataclass
class Motion:
    """Commanded and limited velocity (ahead, left, turn), wheel angles, and the odometry."""

    angles: Array
    command: Array = field(default_factory=lambda: np.zeros(3))
    allowed: Array = field(default_factory=lambda: np.zeros(3))
    pose: Array = field(default_factory=lambda: np.zeros(3))
    stamp_ns: int = -1


class MecanumDrive(Plugin):
    """gz's MecanumDrive system; ``<fdir1>`` of the wheels' surfaces gives the direction of their rollers."""

    names = ("gz-sim-mecanum-drive-system",)
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, name = description.element, context.model_name
        self.joints = tuple(self.parameters.require_joint(tag) for tag in _WHEELS)
        sizes = {"wheel_separation": 1.0, "wheelbase": 1.0, "wheel_radius": 0.2}
        given = {tag: element.number_of(tag, default=size) for tag, size in sizes.items()}
        for tag, size in given.items():
            if size <= 0:
                raise element.error(f"<{tag}> should be positive, got {size:g}")
        self.radius = given["wheel_radius"]
        self._mix = _MIX * (1.0, 1.0, (given["wheel_separation"] + given["wheelbase"]) / 2)
        self._unmix = np.linalg.pinv(self._mix)
        self.limits = Limits(
            element.number_of("min_velocity", default=-math.inf),
            element.number_of("max_velocity", default=math.inf),
            element.number_of("min_acceleration", default=-math.inf),
            element.number_of("max_acceleration", default=math.inf),
        )
        rate = element.number_of("odom_publish_frequency", default=50.0)
        self.period = 1.0 / rate if rate > 0 else 0.0
        self.command_topic, self.odometry_topic, self.tf_topic = (
            absolute_topic(element.text_of(tag, default=f"/model/{name}/{word}"), context.namespace)
            for tag, word in (("topic", "cmd_vel"), ("odom_topic", "odometry"), ("tf_topic", "tf"))
        )
        base = next(iter(context.model.links), "base_link")
        self.odometry_frame = frame(element.text_of("frame_id", default=f"{name}/odom"))
        self.base_frame = frame(element.text_of("child_frame_id", default=f"{name}/{base}"))

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry and its transform."""
        return {self.odometry_topic: OdometrySample, self.tf_topic: TransformSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded velocity."""
        return {self.command_topic: Subscription(TwistCommand, self._command)}

    def prepare(self, build: ModelBuild) -> None:
        """Add a velocity servo to each wheel."""
        mass = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        driven = mass * self.radius**2 / len(self.joints)
        self._servos = [
            build.add_velocity_servo(joint, 2 * driven / SERVO_TIME, math.inf, rotor=driven) for joint in self.joints
        ]

    def bind(self, instance: Instance) -> None:
        """Find wheels and servos."""
        self._physics = instance.physics
        self._controls = [instance.actuator(servo) for servo in self._servos]
        self._wheels = [instance.joint(joint) for joint in self.joints]

    def start(self) -> Motion:
        """Return the state at rest."""
        return Motion(self._angles())

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Measure, then drive."""
        motion = self.state
        step = self.period or self._physics.model.opt.timestep
        elapsed = step if motion.stamp_ns < 0 else (now_ns - motion.stamp_ns) * 1e-9
        motion.stamp_ns = now_ns
        odometry = self._odometry(now_ns, elapsed)
        motion.allowed = np.array(
            [self.limits.apply(w, now, elapsed) for w, now in zip(motion.command, motion.allowed, strict=True)]
        )
        self._physics.data.ctrl[self._controls] = self._mix @ motion.allowed / self.radius
        yield odometry
        yield transform_of(odometry, self.tf_topic)

    def _command(self, command: TwistCommand) -> None:
        self.state.command = np.array((command.linear[0], command.linear[1], command.angular[2]), dtype=np.float64)

    def _odometry(self, now_ns: int, elapsed: float) -> OdometrySample:
        motion = self.state
        angles = self._angles()
        ahead, left, turn = (self._unmix @ (angles - motion.angles) * self.radius).tolist()
        motion.angles = angles
        motion.pose = move_along_arc(motion.pose, ahead, turn, left)
        frames = self.odometry_frame, self.base_frame
        velocity = ahead / elapsed, left / elapsed, turn / elapsed
        return wheel_odometry(now_ns, self.odometry_topic, frames, motion.pose, velocity)

    def _angles(self) -> Array:
        return np.array([wheel.position for wheel in self._wheels])
