"""Gazebo classic's plugins that only set a sensor's topic and frame."""

from __future__ import annotations

from dataclasses import replace

from daidalos.simulation.contracts import Sensor, SensorPlugin
from daidalos.simulation.sensors.contact import ContactSensor
from daidalos.simulation.sensors.navsat import NavSat
from daidalos.simulation.topics import frame


class NamesTopic(SensorPlugin):
    """GPS, sonar, altimeter and magnetometer of ROS 2; the default topic is ``~/out``."""

    names = (
        *("gazebo_ros_gps_sensor", "gazebo_ros_sonar", "hector_gazebo_ros_sonar"),
        *("gazebo_ros_magnetometer", "gazebo_ros_altimeter"),
    )

    # Gazebo classic takes x for west and y for south where the heading is 0; worlds for it say 180 to mean none.
    _CLASSIC_NORTH = 180.0

    def configure(self, sensor: Sensor) -> None:
        """Set topic and frame."""
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="~/out"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", "frameId", default=sensor.frame_id))
        if isinstance(sensor, NavSat) and sensor.origin.heading == self._CLASSIC_NORTH:
            sensor.origin = replace(sensor.origin, heading=0.0)


class Bumper(SensorPlugin):
    """``libgazebo_ros_bumper.so``: a contact sensor's ``bumper_states``."""

    names = ("gazebo_ros_bumper",)

    def configure(self, sensor: Sensor) -> None:
        """Set topic and frame."""
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic(element.text_of("bumperTopicName", "topicName", default="bumper_states"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        if isinstance(sensor, ContactSensor):
            sensor.as_bumper = True
