"""Joint state publisher: true positions, velocities and efforts of joints."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from daidalos.description.link import Plugin as Description
from daidalos.samples.sensors import JointStateSample, Sample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.instance import Instance
from daidalos.simulation.topics import absolute_topic


class JointStatePublisher(Plugin):
    """``libgazebo_ros_joint_state_publisher.so`` of ROS 1 and 2, and gz's JointStatePublisher system."""

    names = ("gazebo_ros_joint_state_publisher", "gz-sim-joint-state-publisher-system")
    sample = JointStateSample

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, parameters = description.element, self.parameters
        self.joints = self._named_joints()
        if parameters.library.startswith("gz-sim-"):
            topic = f"/world/{context.world.name}/model/{context.model_name}/joint_state"
            self.topic = absolute_topic(element.text_of("topic", default=topic), context.namespace)
            rate = element.number_of("update_rate", default=0.0)
        else:
            self.topic = parameters.topic(element.text_of("topicName", "topic_name", default="joint_states"))
            rate = element.number_of("updateRate", "update_rate", default=100.0)
        self.period = 1.0 / rate if rate > 0 else 0.0

    def _named_joints(self) -> tuple[str, ...] | None:
        """Return the named joints that move; None where none is named, which means all."""
        elements = self.parameters.element.all("jointName", "joint_name")
        named = [(name, child) for child in elements for name in re.split(r"[\s,]+", child.text) if name]
        joints = []
        for name, child in named:
            try:
                joints.append(self.context.require_joint(self.parameters.scoped(name), child))
            except AbsentPartError as problem:
                self.context.warn(f"{problem}; not published")
        return tuple(joints) if named else None

    def bind(self, instance: Instance) -> None:
        """Find the joints; without names all that move."""
        self._instance = instance
        moving = tuple(name for name, added in instance.build.joints.items() if added)
        names = moving if self.joints is None else self.joints
        joints = [instance.joint(name) for name in names]
        self._names = names
        self._qpos = np.array([joint.qpos for joint in joints], dtype=np.intp)
        self._dof = np.array([joint.dof for joint in joints], dtype=np.intp)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return the joint states."""
        if not self._instance.has_subscribers(self.topic):
            return
        data = self._instance.physics.data
        yield JointStateSample(
            stamp_ns=now_ns,
            topic=self.topic,
            frame_id="",
            names=self._names,
            positions=data.qpos[self._qpos].copy(),
            velocities=data.qvel[self._dof].copy(),
            efforts=data.qfrc_actuator[self._dof].copy(),
        )
