"""Gazebo classic's force-torque plugin: a sensor in a joint, without a ``<sensor>``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from daidalos.common.suggestions import hint
from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.markup import Element
from daidalos.simulation.contracts import Component, ComponentContext, Plugin
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.noise import Noise
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.sensors.force_torque import ForceTorque
from daidalos.simulation.topics import frame


class ForceTorqueOfJoint(Plugin):
    """``libgazebo_ros_ft_sensor.so``: the wrench in a joint, or in the joint of a link, on ``wrench``."""

    names = ("gazebo_ros_ft_sensor",)

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Yield the sensor."""
        parameters = PluginParameters(description, context)
        element = description.element
        joint = _joint(parameters, context)
        child = context.model.joints[joint].child
        rate = element.number_of("updateRate", "update_rate", default=0.0)
        source = Element("sensor", {"name": description.name}, source=element.source, line=element.line)
        sensor = ForceTorque(
            SensorDescription(description.name, "force_torque", source, update_rate=rate),
            replace(context, link=child, joint=joint),
        )
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="wrench"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        sensor.from_child = False
        stddev = element.number_of("gaussianNoise", "gaussian_noise", default=0.0)
        if stddev > 0:
            sensor.set_noise(Noise(stddev=stddev))
        return (sensor,)


def _joint(parameters: PluginParameters, context: ComponentContext) -> str:
    """Return the named joint, or the parent joint of the named link."""
    element, joints = parameters.element, context.model.joints
    named = parameters.scoped(element.text_of("jointName", "joint_name"))
    body = parameters.scoped(element.text_of("bodyName", "body_name"))
    if named in joints:
        return named
    if named or not body:
        raise AbsentPartError(f"there is no joint {named!r}{hint(named, joints)}", element)
    above = next((joint.name for joint in joints.values() if joint.child == body), "")
    if not above:
        raise AbsentPartError(f"<body_name> is {body!r}, expected a link that hangs on a joint", element)
    return above
