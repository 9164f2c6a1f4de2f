"""Pose publisher: where the links of a model are, as transforms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from daidalos.description.link import Plugin as Description
from daidalos.description.pose import Pose
from daidalos.simulation.component import Setting
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.base import Plugin
from daidalos.simulation.samples import Sample, TransformSample
from daidalos.simulation.topics import absolute_topic


class PosePublisher(Plugin):
    """gz's PosePublisher system: links in the model's frame, and the model in the world where that is wanted."""

    names = ("gz-sim-pose-publisher-system",)

    def __init__(self, description: Description, setting: Setting) -> None:
        super().__init__(description, setting)
        element, name = description.element, setting.model_name
        self.topic = absolute_topic(f"/model/{name}/pose", setting.namespace)
        self.links = element.flag_of("publish_link_pose", default=True)
        self.model = element.flag_of("publish_model_pose", default=False) or element.flag_of(
            "publish_nested_model_pose", default=False
        )
        rate = element.number_of("update_frequency", default=-1.0)
        self.period = 1.0 / rate if rate > 0 else 0.0

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """One topic."""
        return {self.topic: TransformSample}

    def bind(self, instance: Instance) -> None:
        """Take the model."""
        self._instance = instance

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Say where everything is."""
        instance = self._instance
        if not instance.heard(self.topic):
            return
        pose = instance.pose
        if self.model:
            yield self._transform(now_ns, self.setting.world.name, instance.name, pose)
        if self.links:
            back = pose.inverse
            for link in instance.model.links:
                child = f"{instance.name}/{link.replace('::', '/')}"
                yield self._transform(now_ns, instance.name, child, back @ instance.link(link).pose)

    def _transform(self, now_ns: int, parent: str, child: str, pose: Pose) -> TransformSample:
        return TransformSample(now_ns, self.topic, parent, child, np.array(pose.position), np.array(pose.orientation))
