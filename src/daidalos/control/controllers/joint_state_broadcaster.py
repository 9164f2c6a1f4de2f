"""Joint state broadcaster: publishes the joint states of the hardware."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, group, parameter
from daidalos.control.contracts import Controller
from daidalos.description.joint import JointType
from daidalos.samples.controllers import DynamicJointSample
from daidalos.samples.sensors import JointStateSample, Sample

_FIELDS = ("position", "velocity", "effort")


@dataclass(frozen=True)
class InterfaceMap(Parameters):
    """Interfaces of the message's fields."""

    position: str = parameter("position", "Interface that positions are taken from.", read_only=True)
    velocity: str = parameter("velocity", "Interface that velocities are taken from.", read_only=True)
    effort: str = parameter("effort", "Interface that efforts are taken from.", read_only=True)


@dataclass(frozen=True)
class JointStateBroadcasterParameters(Parameters):
    """Parameters of the joint state broadcaster, as ROS names them."""

    use_local_topics: bool = parameter(
        False, "Whether to publish on topics below the controller's name.", read_only=True
    )
    joints: tuple[str, ...] = parameter(
        (), "Joints that are published, in this order; empty for all interfaces.", unique=True, read_only=True
    )
    extra_joints: tuple[str, ...] = parameter(
        (), "Further joints that are published at zero.", unique=True, read_only=True
    )
    interfaces: tuple[str, ...] = parameter(
        (), "Interfaces that are published; empty for all.", unique=True, read_only=True
    )
    map_interface_to_joint_state: InterfaceMap = group(InterfaceMap)
    use_urdf_to_filter: bool = parameter(
        True, "Whether to leave out what is not a joint of the robot's description.", read_only=True
    )
    frame_id: str = parameter("base_link", "Frame in the messages' headers.", read_only=True)
    publish_dynamic_joint_states: bool = parameter(
        True, "Whether all interfaces are published as well.", read_only=True
    )


class JointStateBroadcaster(Controller):
    """Broadcaster of ``joint_states`` (position, velocity, effort) and ``dynamic_joint_states`` (all interfaces)."""

    names = ("joint_state_broadcaster/JointStateBroadcaster",)
    Parameters = JointStateBroadcasterParameters
    parameters: JointStateBroadcasterParameters

    def configure(self) -> None:
        """Set the topics, and select interfaces and joints."""
        p = self.parameters
        prefix = "~/" if p.use_local_topics else ""
        self._topic, self._dynamic_topic = f"{prefix}joint_states", f"{prefix}dynamic_joint_states"
        chosen = p.map_interface_to_joint_state
        self._wanted = dict(zip((chosen.position, chosen.velocity, chosen.effort), _FIELDS, strict=True))
        self.select_states(self.context.state_names)

    def select_states(self, available: Sequence[str]) -> None:
        """Select the given interfaces and joints, or all that are available."""
        p = self.parameters
        if p.joints and p.interfaces:
            self.state_names = tuple(f"{joint}/{interface}" for joint in p.joints for interface in p.interfaces)
        else:
            self.state_names = tuple(available)
        places: dict[str, dict[str, int]] = {}
        for place, name in enumerate(self.state_names):
            joint, _, interface = name.rpartition("/")
            places.setdefault(joint, {})[interface] = place
        self._dynamic = {**places, **{joint: {} for joint in p.extra_joints if joint not in places}}
        joints = [joint for joint in places if self._is_joint(joint) and self._wanted.keys() & places[joint].keys()]
        self._joints = (*joints, *(joint for joint in p.extra_joints if joint not in joints))
        count = len(self.state_names)
        self._rows = {
            kind: np.array([places.get(joint, {}).get(interface, count) for joint in self._joints], dtype=np.intp)
            for interface, kind in self._wanted.items()
        }
        self._missing = np.array([np.nan] * len(joints) + [0.0] * (len(self._joints) - len(joints)))

    def _is_joint(self, name: str) -> bool:
        """Return whether a name belongs into joint states."""
        robot = self.context.robot
        if robot is None or self.parameters.joints or not self.parameters.use_urdf_to_filter:
            return True
        return name in robot.joints and robot.joints[name].type is not JointType.FIXED

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Joint states, and dynamic joint states if enabled."""
        topics: dict[str, type[Sample]] = {self._topic: JointStateSample}
        if self.parameters.publish_dynamic_joint_states:
            topics[self._dynamic_topic] = DynamicJointSample
        return topics

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Read the interfaces and return the samples."""
        values = self.states.read()
        if self.context.has_subscribers(self._topic):
            yield self._joint_states(now_ns, values)
        if self.parameters.publish_dynamic_joint_states and self.context.has_subscribers(self._dynamic_topic):
            yield DynamicJointSample(
                stamp_ns=now_ns,
                topic=self._dynamic_topic,
                frame_id=self.parameters.frame_id,
                joints={
                    joint: {interface: float(values[place]) for interface, place in places.items()}
                    or dict.fromkeys(_FIELDS, 0.0)
                    for joint, places in self._dynamic.items()
                },
            )

    def _joint_states(self, now_ns: int, values: np.ndarray) -> JointStateSample:
        with_nothing = np.append(values, np.nan)
        columns = {kind: with_nothing[rows] for kind, rows in self._rows.items()}
        extra = self._missing == 0.0
        for column in columns.values():
            column[extra] = 0.0
        return JointStateSample(
            stamp_ns=now_ns,
            topic=self._topic,
            frame_id=self.parameters.frame_id,
            names=self._joints,
            positions=columns["position"],
            velocities=columns["velocity"],
            efforts=columns["effort"],
        )
