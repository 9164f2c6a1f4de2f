"""Gazebo classic's force-torque plugin: a sensor in a joint, without a ``<sensor>``."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.markup import Element
from daidalos.simulation.component import Component, Setting
from daidalos.simulation.noise import Noise
from daidalos.simulation.plugins.base import Parameters, Plugin
from daidalos.simulation.sensors.force_torque import ForceTorque
from daidalos.simulation.topics import frame


class ForceTorqueOfJoint(Plugin):
    """``libgazebo_ros_ft_sensor.so``: what a joint carries, on ``wrench``."""

    names = ("gazebo_ros_ft_sensor",)

    @classmethod
    def make(cls, description: PluginDescription, setting: Setting) -> Iterable[Component]:
        """Make the sensor itself."""
        parameters = Parameters(description, setting)
        element = description.element
        joint = parameters.scoped(element.text_of("jointName", "joint_name"))
        if joint not in setting.model.joints:
            known = ", ".join(setting.model.joints) or "none"
            raise element.error(f"<joint_name> is {joint!r}, expected one of the joints {known}")
        child = setting.model.joints[joint].child
        rate = element.number_of("updateRate", "update_rate", default=0.0)
        source = Element("sensor", {"name": description.name}, source=element.source, line=element.line)
        sensor = ForceTorque(
            SensorDescription(description.name, "force_torque", source, update_rate=rate), child, setting, joint
        )
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="wrench"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        sensor.from_child = False
        stddev = element.number_of("gaussianNoise", "gaussian_noise", default=0.0)
        if stddev > 0:
            sensor.set_noise(Noise(stddev=stddev))
        return (sensor,)
