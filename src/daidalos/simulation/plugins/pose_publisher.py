"""Pose publisher: poses of a model's links as transforms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.common.rate_gate import RateGate
from daidalos.description.joint import JointType
from daidalos.description.link import Plugin as Description
from daidalos.samples.sensors import Sample, TransformSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.instance import Instance
from daidalos.simulation.topics import absolute_topic


class PosePublisher(Plugin):
    """gz's PosePublisher system: links in the model's frame, and optionally the model in the world.

    With ``static_publisher`` what no joint moves has a topic and a rate of its own.
    """

    names = ("gz-sim-pose-publisher-system",)
    unused = ("publish_sensor_pose", "publish_collision_pose", "publish_visual_pose", "use_pose_vector_msg")

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, name = description.element, context.model_name
        self.topic = absolute_topic(f"/model/{name}/pose", context.namespace)
        self.links = element.flag_of("publish_link_pose", default=True)
        self.model = element.flag_of("publish_model_pose", default=False) or element.flag_of(
            "publish_nested_model_pose", default=False
        )
        rate = element.number_of("update_frequency", default=-1.0)
        self.period = 1.0 / rate if rate > 0 else 0.0
        self.static_topic = f"{self.topic}_static" if element.flag_of("static_publisher", default=False) else ""
        self._static_gate = RateGate(element.number_of("static_update_frequency", default=rate))

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topics of the transforms."""
        return {topic: TransformSample for topic in (self.topic, self.static_topic) if topic}

    def bind(self, instance: Instance) -> None:
        """Find the model."""
        self._instance = instance
        moved = {joint.child for joint in instance.model.joints.values() if joint.type is not JointType.FIXED}
        self._topics = {
            link: self.static_topic if self.static_topic and link not in moved else self.topic
            for link in instance.model.links
        }

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return the transforms."""
        instance = self._instance
        due = {topic for topic in (self.topic, self.static_topic) if topic and instance.has_subscribers(topic)}
        if self.static_topic in due and not self._static_gate.is_due(now_ns):
            due.discard(self.static_topic)
        if not due:
            return
        pose = instance.pose
        if self.model and self.topic in due:
            yield self._transform(now_ns, self.topic, self.context.world.name, instance.name, pose)
        if self.links:
            back = pose.inverse
            for link, topic in self._topics.items():
                if topic in due:
                    child = f"{instance.name}/{link.replace('::', '/')}"
                    yield self._transform(now_ns, topic, instance.name, child, back @ instance.link(link).pose)

    def _transform(self, now_ns: int, topic: str, parent: str, child: str, pose: Pose) -> TransformSample:
        return TransformSample(now_ns, topic, parent, child, np.array(pose.position), np.array(pose.orientation))
