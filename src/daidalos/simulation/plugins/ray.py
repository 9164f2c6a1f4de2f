"""Gazebo classic's lidar plugins: topic, frame and message of a ray sensor."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from daidalos.simulation.contracts import Sensor, SensorPlugin
from daidalos.simulation.sensors.lidar import Lidar
from daidalos.simulation.topics import frame

_UNUSED = ("hokuyoMinIntensity", "min_intensity", "organize_cloud", "updateRate", "update_rate")
"""Parameters of lidars that mean nothing here."""


class ScanPlugin(SensorPlugin):
    """Plugin of ROS 1 that sets topic, frame and noise of scans."""

    unused: ClassVar[tuple[str, ...]] = _UNUSED

    def configure(self, sensor: Sensor) -> None:
        """Set topic, frame and noise."""
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="scan"))
        sensor.frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        if isinstance(sensor, Lidar):
            sensor.as_points = sensor.as_both = False
            stddev = element.number_of("gaussianNoise", "gaussian_noise", default=0.0)
            if stddev > 0:
                sensor.noise = replace(sensor.noise, stddev=stddev)


class Laser(ScanPlugin):
    """ROS 1's ``libgazebo_ros_laser.so``: scans on ``topicName``."""

    names = ("gazebo_ros_laser", "gazebo_ros_gpu_laser")


class BlockLaser(ScanPlugin):
    """ROS 1's ``libgazebo_ros_block_laser.so`` and the Velodyne plugins: points on ``topicName``."""

    names = ("gazebo_ros_block_laser", "gazebo_ros_velodyne_laser", "gazebo_ros_velodyne_gpu_laser")

    def configure(self, sensor: Sensor) -> None:
        """Set topic, frame and noise, with points as message."""
        super().configure(sensor)
        if isinstance(sensor, Lidar):
            sensor.as_points = True
            sensor.range_min = self.parameters.element.number_of("min_range", default=sensor.range_min)
            sensor.range_max = self.parameters.element.number_of("max_range", default=sensor.range_max)


class RaySensor(SensorPlugin):
    """ROS 2's ``libgazebo_ros_ray_sensor.so``: scans or points on ``~/out``."""

    names = ("gazebo_ros_ray_sensor",)
    unused = _UNUSED

    def configure(self, sensor: Sensor) -> None:
        """Set topic, frame and message type."""
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic("~/out")
        sensor.frame_id = frame(element.text_of("frame_name", default=sensor.frame_id))
        if isinstance(sensor, Lidar):
            sensor.as_both = False
            kind = element.text_of("output_type", default="sensor_msgs/PointCloud2")
            sensor.as_points = not kind.endswith(("LaserScan", "Range"))
            sensor.as_range = kind.endswith("Range")
            sensor.ultrasound = element.text_of("radiation_type") == "ultrasound"
            if kind.endswith("PointCloud"):
                sensor.context.warn(f"{element.where}: <output_type> is {kind}; it is published as PointCloud2")


class RangeSensor(ScanPlugin):
    """``libgazebo_ros_range.so``: the shortest ray, as an infrared or ultrasound sensor."""

    names = ("gazebo_ros_range",)
    unused = (*_UNUSED, "fov")

    def configure(self, sensor: Sensor) -> None:
        """Set topic, frame and noise."""
        super().configure(sensor)
        parameters, element = self.parameters, self.parameters.element
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="range"))
        if isinstance(sensor, Lidar):
            sensor.as_range = True
            sensor.ultrasound = element.text_of("radiation").lower() == "ultrasound"
