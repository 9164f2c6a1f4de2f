"""Gazebo classic's IMU plugins."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from daidalos.common.pose3 import Pose
from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.markup import Element
from daidalos.simulation.contracts import Component, ComponentContext, Plugin, Sensor, SensorPlugin
from daidalos.simulation.noise import Noise
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.sensors.imu import Imu
from daidalos.simulation.topics import frame


class ImuOfModel(Plugin):
    """ROS 1's ``libgazebo_ros_imu.so``: an IMU on the link ``bodyName``, without a ``<sensor>``."""

    names = ("gazebo_ros_imu",)
    unused = ("serviceName",)

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Yield the sensor."""
        parameters = PluginParameters(description, context)
        element = description.element
        link = parameters.require_link("bodyName", "body_name", "link_name")
        sensor = Imu(
            SensorDescription(
                name=description.name,
                type="imu",
                element=element,
                pose=_offset(element),
                update_rate=element.number_of("updateRate", "update_rate", default=0.0),
            ),
            replace(context, link=link),
        )
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="imu"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        _apply_noise(sensor, element)
        return (sensor,)


class ImuOfSensor(SensorPlugin):
    """``libgazebo_ros_imu_sensor.so``: topic and frame of an IMU sensor."""

    names = ("gazebo_ros_imu_sensor",)
    unused = ("bodyName", "serviceName")

    def configure(self, sensor: Sensor) -> None:
        """Set topic and frame, and ROS 1's further settings: rate, pose and noise."""
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="~/out"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        rate = element.number_of("updateRateHZ", default=0.0)
        sensor.period = 1.0 / rate if rate > 0 else sensor.period
        if element.first("xyzOffset", "rpyOffset") is not None:
            sensor.pose = sensor.pose @ _offset(element)
        if isinstance(sensor, Imu):
            sensor.starts_level = element.flag_of(
                "initialOrientationAsReference", "initial_orientation_as_reference", default=False
            )
            _apply_noise(sensor, element)


def _offset(element: Element) -> Pose:
    xyz = element.vector_of("xyzOffset", "xyzOffsets", size=3, default=(0.0, 0.0, 0.0))
    return Pose.from_xyz_rpy(xyz, element.vector_of("rpyOffset", "rpyOffsets", size=3, default=(0.0, 0.0, 0.0)))


def _apply_noise(sensor: Imu, element: Element) -> None:
    stddev = element.number_of("gaussianNoise", "gaussian_noise", default=0.0)
    if stddev > 0:
        sensor.rate_noise = _at_least(sensor.rate_noise, stddev)
        sensor.acceleration_noise = _at_least(sensor.acceleration_noise, stddev)


def _at_least(noises: tuple[Noise, ...], stddev: float) -> tuple[Noise, ...]:
    return tuple(replace(noise, stddev=max(noise.stddev, stddev)) for noise in noises)
