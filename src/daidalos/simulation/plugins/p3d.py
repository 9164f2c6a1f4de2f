"""True odometry of one link: Gazebo classic's p3d and gz's odometry publisher."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.samples.odometry import transform_of
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample
from daidalos.simulation.contracts import ComponentContext, Plugin
from daidalos.simulation.instance import Instance
from daidalos.simulation.plugins.truth import true_odometry
from daidalos.simulation.topics import absolute_topic, frame


class P3d(Plugin):
    """``libgazebo_ros_p3d.so`` of ROS 1 and 2: the pose of a link in the world or relative to another link."""

    names = ("gazebo_ros_p3d",)
    sample = OdometrySample

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, parameters = description.element, self.parameters
        self.link = parameters.require_link("bodyName", "body_name", default=next(iter(context.model.links), ""))
        self.frame_id = frame(element.text_of("frameName", "frame_name", default="world"))
        self.topic = parameters.topic(element.text_of("topicName", "topic_name", default="odom"))
        self.offset = _read_offset(element)
        self.noise = element.number_of("gaussianNoise", "gaussian_noise", default=0.0)
        rate = element.number_of("updateRate", "update_rate", default=0.0)
        self.period = 1.0 / rate if rate > 0 else 0.0

    def bind(self, instance: Instance) -> None:
        """Find the link and its reference link."""
        self._instance = instance
        self._link = instance.link(self.link)
        scoped = self.parameters.scoped(self.frame_id)
        self._from = instance.link(scoped) if scoped in instance.build.bodies else None

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return the odometry of the link."""
        if not self._instance.has_subscribers(self.topic):
            return
        origin = Pose() if self._from is None else self._from.pose
        odometry = true_odometry(
            self._link, now_ns, self.topic, self.frame_id, self.link.rpartition("::")[2], (1e-6,) * 3, origin
        )
        noise = self.random.normal(0.0, self.noise, (2, 3)) if self.noise else np.zeros((2, 3))
        yield replace(
            _moved(odometry, self.offset), linear=odometry.linear + noise[0], angular=odometry.angular + noise[1]
        )


class OdometryPublisher(Plugin):
    """gz's OdometryPublisher system: the model's odometry since its insertion, without wheels."""

    names = ("gz-sim-odometry-publisher-system",)
    unused = ("dimensions", "odom_covariance_topic")

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element, name = description.element, context.model_name
        base = next(iter(context.model.links), "base_footprint")
        self.odometry_frame = frame(element.text_of("odom_frame", default=f"{name}/odom"))
        self.base_frame = frame(element.text_of("robot_base_frame", default=f"{name}/base_footprint"))
        self.link = base
        self.noise = element.number_of("gaussian_noise", default=0.0)
        self.offset = _read_offset(element)
        topic = element.text_of("odom_topic", default=f"/model/{name}/odometry")
        self.topic = absolute_topic(topic, context.namespace)
        self.tf_topic = absolute_topic(element.text_of("tf_topic", default=f"/model/{name}/pose"), context.namespace)
        rate = element.number_of("odom_publish_frequency", default=50.0)
        self.period = 1.0 / rate if rate > 0 else 0.0

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry and its transform."""
        return {self.topic: OdometrySample, self.tf_topic: TransformSample}

    def bind(self, instance: Instance) -> None:
        """Find the first link."""
        self._link = instance.link(self.link)

    def start(self) -> Pose:
        """Return the current pose as the origin."""
        return self._link.pose

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return the odometry of the model."""
        frames = self.odometry_frame, self.base_frame
        odometry = _moved(true_odometry(self._link, now_ns, self.topic, *frames, start=self.state), self.offset)
        if self.noise:
            noise = self.random.normal(0.0, self.noise, (3, 3))
            odometry = replace(
                odometry,
                position=odometry.position + noise[0],
                linear=odometry.linear + noise[1],
                angular=odometry.angular + noise[2],
            )
        yield odometry
        yield transform_of(odometry, self.tf_topic)


def _read_offset(element: Element) -> Pose:
    xyz = element.vector_of("xyzOffset", "xyzOffsets", "xyz_offset", "xyz_offsets", size=3, default=(0.0,) * 3)
    rpy = element.vector_of("rpyOffset", "rpyOffsets", "rpy_offset", "rpy_offsets", size=3, default=(0.0,) * 3)
    return Pose.from_xyz_rpy(xyz, rpy)


def _moved(odometry: OdometrySample, offset: Pose) -> OdometrySample:
    moved = offset @ Pose(_triple(odometry.position), _quadruple(odometry.orientation))
    return replace(odometry, position=np.array(moved.position), orientation=np.array(moved.orientation))


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _quadruple(values: np.ndarray) -> tuple[float, float, float, float]:
    x, y, z, w = (float(value) for value in values)
    return x, y, z, w
