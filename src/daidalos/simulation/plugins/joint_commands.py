"""Joints that follow topics: joint trajectories, and gz's controllers of single joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.suggestions import hint
from daidalos.description.joint import JointType
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.samples.commands import NumberCommand, PositionTrajectoryCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import Sample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.instance import Instance
from daidalos.simulation.topics import absolute_topic
from daidalos.simulation.trajectory_follower import ActiveTrajectory, place_joints

_GAINS = ("p_gain", "i_gain", "d_gain", "i_min", "i_max", "cmd_min", "cmd_max", "cmd_offset")


class JointPoseTrajectory(Plugin):
    """``libgazebo_ros_joint_pose_trajectory.so``: sets joints to the positions of a trajectory without forces.

    gz's JointTrajectoryController does the same and holds the joints at the end, and at the start where that says
    where; its gains are not needed.
    """

    names = ("gazebo_ros_joint_pose_trajectory", "gz-sim-joint-trajectory-controller-system")
    unused = (
        *("serviceName", "use_header_start_time"),
        *(f"{kind}_{what}" for kind in ("position", "velocity") for what in _GAINS),
    )
    state: ActiveTrajectory | None

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self._holds = self.parameters.library.startswith("gz-")
        self._initial: ActiveTrajectory | None = None
        if self._holds:
            self._initial = self._initial_trajectory(element)
            topic = element.text_of("topic", default=f"/model/{context.model_name}/joint_trajectory")
            self.topic = absolute_topic(topic, context.namespace)
        else:
            name = element.text_of("topicName", "topic_name", default="set_joint_trajectory")
            self.topic = self.parameters.topic(name)
        rate = element.number_of("updateRate", "update_rate", default=0.0)
        self.period = 1.0 / rate if rate > 0 else 0.0
        self._now_ns = 0

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """The trajectory."""
        return {self.topic: Subscription(PositionTrajectoryCommand, self._command)}

    def start(self) -> ActiveTrajectory | None:
        """Return the initial trajectory of the description, if it has one."""
        return self._initial

    def bind(self, instance: Instance) -> None:
        """Find the joints that move."""
        self._instance = instance
        self._joints = {name for name, added in instance.build.joints.items() if added}

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Set the joints to their interpolated positions at the current time."""
        self._now_ns = now_ns
        course = self.state
        if course is None:
            return ()
        if place_joints(self._instance, course, now_ns, self.parameters.scoped) and not self._holds:
            self.state = None
        return ()

    def _command(self, command: PositionTrajectoryCommand) -> None:
        unknown = [name for name in command.joints if self.parameters.scoped(name) not in self._joints]
        if unknown or not len(command.times):
            words = f"there is no movable joint {unknown[0]!r}" if unknown else "it has no points"
            self.context.warn(f"{self.topic}: the trajectory is ignored, {words}")
            return
        self.state = ActiveTrajectory(command, self._now_ns)

    def _initial_trajectory(self, element: Element) -> ActiveTrajectory | None:
        """Return a trajectory that holds the initial positions, in the order of the joints."""
        scope = f"{self.parameters.scope}::" if self.parameters.scope else ""
        joints = self.context.model.joints.values()
        turning = [joint.name for joint in joints if joint.type is not JointType.FIXED]
        movable = [name.removeprefix(scope) for name in turning if name.startswith(scope)]
        names = [child.text.strip() for child in element.all("joint_name")] or movable
        positions = [child.number() for child in element.all("initial_position")]
        unknown = [name for name in names if name not in movable]
        if unknown:
            raise AbsentPartError(f"there is no movable joint {unknown[0]!r}{hint(unknown[0], movable)}", element)
        if len(positions) > len(names):
            raise element.error(f"expected at most {len(names)} <initial_position>, got {len(positions)}")
        if not positions:
            return None
        return ActiveTrajectory(
            PositionTrajectoryCommand(tuple(names[: len(positions)]), np.zeros(1), np.array([positions])), 0
        )


@dataclass
class Hold:
    """Target of the joints, and the integral part of the effort on each."""

    target: float
    integrals: list[float]
    stamp_ns: int = -1


class JointController(Plugin):
    """gz's JointController (velocities) and JointPositionController (positions): one target for one or more joints.

    A speed is held without any gains. A position is held by a PID loop whose proportional and derivative parts
    belong to the physics, which keeps stiff ones stable.
    """

    names = ("gz-sim-joint-controller-system", "gz-sim-joint-position-controller-system")
    unused = ("use_force_commands", *_GAINS)
    state: Hold
    period = 0.01

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        self.joints = self.parameters.require_joints("joint_name")
        self.holds_position = "position" in self.parameters.library
        model = f"/model/{context.model_name}"
        axis = element.integer_of("joint_index", default=0)
        words = f"{axis}/cmd_pos" if self.holds_position else "cmd_vel"
        below = element.text_of("sub_topic")
        default = f"{model}/{below}" if below else f"{model}/joint/{self.joints[0]}/{words}"
        self.topic = absolute_topic(element.text_of("topic", default=default), context.namespace)
        self.gain = element.number_of("p_gain", default=1.0)
        self.damping = element.number_of("d_gain", default=0.1)
        self.integral_gain = element.number_of("i_gain", default=0.1) if self.holds_position else 0.0
        self.integral_limits = element.number_of("i_min", default=-1.0), element.number_of("i_max", default=1.0)
        if self.integral_limits[0] > self.integral_limits[1]:
            raise element.error("<i_min> is above <i_max>")
        self.effort = element.number_of("cmd_max", default=float("inf"))
        self.initial = element.number_of("initial_position", "initial_velocity", default=0.0)

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic of the target position or velocity."""
        return {self.topic: Subscription(NumberCommand, self._command)}

    def prepare(self, build: ModelBuild) -> None:
        """Add a servo to each joint."""
        effort = self.effort if self.effort > 0 else float("inf")
        weight = sum(link.inertial.mass for link in build.model.links.values() if link.inertial)
        self._servos = [
            build.add_position_servo(joint, self.gain, self.damping, effort)
            if self.holds_position
            else build.add_velocity_servo(joint, max(self.gain, 10 * weight), effort)
            for joint in self.joints
        ]

    def bind(self, instance: Instance) -> None:
        """Find joints and servos."""
        self._data = instance.physics.data
        self._controls = [instance.actuator(servo) for servo in self._servos]
        self._views = [instance.joint(joint) for joint in self.joints]

    def start(self) -> Hold:
        """Return the initial target of the description."""
        hold = Hold(self.initial, [0.0] * len(self.joints))
        self._set_servos(hold)
        return hold

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Update the integrals."""
        hold = self.state
        elapsed = (now_ns - hold.stamp_ns) * 1e-9 if hold.stamp_ns >= 0 else 0.0
        hold.stamp_ns = now_ns
        if self.integral_gain > 0:
            lower, upper = self.integral_limits
            more = (self.integral_gain * (hold.target - view.position) * elapsed for view in self._views)
            hold.integrals = [min(max(i + m, lower), upper) for i, m in zip(hold.integrals, more, strict=True)]
            self._set_servos(hold)
        return ()

    def _set_servos(self, hold: Hold) -> None:
        """Set the servos; the integral part of the effort is added as a position offset."""
        for control, integral in zip(self._controls, hold.integrals, strict=True):
            self._data.ctrl[control] = hold.target + (integral / self.gain if self.gain > 0 else 0.0)

    def _command(self, command: NumberCommand) -> None:
        self.state.target = command.value
        self._set_servos(self.state)
