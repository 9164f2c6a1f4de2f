"""Differential drive: wheel velocities from a commanded velocity, odometry from the wheels."""

from __future__ import annotations

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
from daidalos.simulation.instance import Instance, JointView, LinkView
from daidalos.simulation.plugins.diff_drive_settings import read_settings
from daidalos.simulation.plugins.truth import link_transforms, true_odometry

SERVO_TIME = 0.005
"""Time constant of the wheel servos [s]; the gain follows from it and the inertia that a wheel moves."""


@dataclass
class Motion:
    """State of the drive's motion.

    Parameters
    ----------
    command : tuple of 2 floats
        Commanded speed ahead [m/s] and turn rate [rad/s].
    allowed : tuple of 2 floats
        The same within the limits.
    rims : tuple of 2 floats
        Speed of the left and right rims that the servos hold [m/s].
    angles : array (2 * pairs,)
        Wheel angles at the last update [rad].
    pose : array (3,)
        By odometry.
    stamp_ns : int
        Of the last update.
    """

    command: tuple[float, float]
    allowed: tuple[float, float]
    rims: tuple[float, float]
    angles: Array
    pose: Array
    stamp_ns: int


class DiffDrive(Plugin):
    """``libgazebo_ros_diff_drive.so`` of ROS 1 and 2, ROS 1's skid steer drive, and gz's DiffDrive system."""

    names = ("gazebo_ros_diff_drive", "gazebo_ros_skid_steer_drive", "gz-sim-diff-drive-system")
    unused = ("num_wheel_pairs",)
    state: Motion

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        self.settings = read_settings(self.parameters, context)
        self.period = self.settings.period

    def prepare(self, build: ModelBuild) -> None:
        """Add a velocity servo to each wheel."""
        settings = self.settings
        mass = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        wheels = (*settings.left, *settings.right)
        self._radii = np.array(settings.diameters * (len(wheels) // len(settings.diameters))) / 2
        self._servos = []
        for joint, radius in zip(wheels, self._radii, strict=True):
            driven = float(mass * radius**2 / len(wheels))
            self._servos.append(build.add_velocity_servo(joint, 2 * driven / SERVO_TIME, settings.torque, rotor=driven))

    def bind(self, instance: Instance) -> None:
        """Find the wheels, their servos and the base."""
        settings = self.settings
        self._instance = instance
        self._controls = np.array([instance.actuator(servo) for servo in self._servos], dtype=np.intp)
        self._wheels: list[JointView] = [instance.joint(j) for j in (*settings.left, *settings.right)]
        self._qpos = np.array([wheel.qpos for wheel in self._wheels], dtype=np.intp)
        self._dof = np.array([wheel.dof for wheel in self._wheels], dtype=np.intp)
        self._sides = np.repeat((0, 1), (len(settings.left), len(settings.right)))
        base = settings.base_frame if settings.base_frame in instance.build.bodies else None
        self._base: LinkView = instance.link(base or next(iter(instance.build.bodies)))

    def start(self) -> Motion:
        """Return the state at rest, at the origin of the odometry frame."""
        return Motion(
            command=(0.0, 0.0),
            allowed=(0.0, 0.0),
            rims=(0.0, 0.0),
            angles=self._angles(),
            pose=np.zeros(3),
            stamp_ns=-1,
        )

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry, its transform and the wheels' joint states, if enabled."""
        settings = self.settings
        topics: dict[str, type[Sample]] = {
            settings.odometry_topic: OdometrySample,
            settings.tf_topic: TransformSample,
            settings.joint_topic: JointStateSample,
        }
        return {topic: sample for topic, sample in topics.items() if topic}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the commanded velocity."""
        return {self.settings.command_topic: Subscription(TwistCommand, self._command)}

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Measure the wheels, then set their velocities for the next period; return what is listened to."""
        settings, motion, heard = self.settings, self.state, self._instance.has_subscribers
        elapsed = self.period or self._instance.physics.model.opt.timestep
        if motion.stamp_ns >= 0:
            elapsed = (now_ns - motion.stamp_ns) * 1e-9
        motion.stamp_ns = now_ns
        travel = None if settings.truth else self._integrate()
        wants_odometry = bool(settings.odometry_topic) and heard(settings.odometry_topic)
        wants_tf = bool(settings.tf_topic) and heard(settings.tf_topic)
        odometry = None
        if wants_odometry or wants_tf:
            odometry = self._true_odometry(now_ns) if travel is None else self._odometry(now_ns, elapsed, *travel)
        self._drive(elapsed)
        if odometry is not None and wants_odometry:
            yield odometry
        if odometry is not None and wants_tf:
            yield transform_of(odometry, settings.tf_topic)
            if settings.publish_wheels:
                joints = [wheel.name for wheel in self._wheels]
                frame = settings.base_frame
                yield from link_transforms(self._instance, self._base, joints, now_ns, settings.tf_topic, frame)
        if settings.joint_topic and heard(settings.joint_topic):
            yield self._joint_states(now_ns)

    def _command(self, command: TwistCommand) -> None:
        self.state.command = float(command.linear[0]), float(command.angular[2])

    def _drive(self, elapsed: float) -> None:
        settings, motion = self.settings, self.state
        speed = settings.linear.apply(motion.command[0], motion.allowed[0], elapsed)
        turn = settings.angular.apply(motion.command[1], motion.allowed[1], elapsed)
        motion.allowed = speed, turn
        reach = settings.wheel_acceleration * elapsed
        wanted = speed - turn * settings.separation / 2, speed + turn * settings.separation / 2
        motion.rims = _nearer(motion.rims[0], wanted[0], reach), _nearer(motion.rims[1], wanted[1], reach)
        self._instance.physics.data.ctrl[self._controls] = np.array(motion.rims)[self._sides] / self._radii

    def _integrate(self) -> tuple[float, float]:
        """Add the wheels' travel since the last update to the pose; return the travel ahead [m] and the turn [rad]."""
        settings, motion = self.settings, self.state
        angles = self._angles()
        travel = settings.encoder.measure((angles - motion.angles) * self._radii, self.random)
        motion.angles = angles
        count = len(settings.left)
        left, right = sum(travel[:count].tolist()) / count, sum(travel[count:].tolist()) / (len(travel) - count)
        forward, turn = (left + right) / 2, (right - left) / settings.separation
        motion.pose = move_along_arc(motion.pose, forward, turn)
        return forward, turn

    def _odometry(self, now_ns: int, elapsed: float, forward: float, turn: float) -> OdometrySample:
        settings = self.settings
        frames, velocity = (settings.odometry_frame, settings.base_frame), (forward / elapsed, 0.0, turn / elapsed)
        return wheel_odometry(now_ns, settings.odometry_topic, frames, self.state.pose, velocity, settings.covariance)

    def _true_odometry(self, now_ns: int) -> OdometrySample:
        s = self.settings
        return true_odometry(self._base, now_ns, s.odometry_topic, s.odometry_frame, s.base_frame, s.covariance)

    def _joint_states(self, now_ns: int) -> JointStateSample:
        return JointStateSample(
            stamp_ns=now_ns,
            topic=self.settings.joint_topic,
            frame_id="",
            names=tuple(wheel.name for wheel in self._wheels),
            positions=self._angles(),
            velocities=np.array(self._instance.physics.data.qvel[self._dof]),
            efforts=np.array(self._instance.physics.data.qfrc_actuator[self._dof]),
        )

    def _angles(self) -> Array:
        angles: Array = self._instance.physics.data.qpos[self._qpos]
        return angles


def _nearer(value: float, wanted: float, reach: float) -> float:
    """Return the value that is nearest to the wanted one within reach."""
    return value + min(max(wanted - value, -reach), reach)
