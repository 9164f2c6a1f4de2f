"""ROS 1's hector plugins: GPS, IMU and magnetometer on a link, without a ``<sensor>``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from daidalos.common.pose3 import Pose
from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.markup import Element
from daidalos.description.world import SphericalCoordinates
from daidalos.simulation.contracts import Component, ComponentContext, Plugin, Sensor
from daidalos.simulation.noise import Noise
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.sensors.imu import Imu
from daidalos.simulation.sensors.magnetometer import Magnetometer
from daidalos.simulation.sensors.navsat import NavSat
from daidalos.simulation.topics import frame


class GpsOfModel(Plugin):
    """``libhector_gazebo_ros_gps.so``: a receiver on the link ``bodyName``.

    Its errors are in metres along the world's axes; ``referenceHeading`` is where x points by compass [deg].
    """

    names = ("hector_gazebo_ros_gps",)
    unused = ("serviceName", "status", "service")

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Yield the sensor."""
        element = description.element
        sensor = NavSat(*_carrier(description, context, "navsat", rate=4.0))
        _name(sensor, PluginParameters(description, context), "fix", "world")
        sensor.origin = SphericalCoordinates(
            latitude=element.number_of("referenceLatitude", default=49.9),
            longitude=element.number_of("referenceLongitude", default=8.9),
            elevation=element.number_of("referenceAltitude", default=0.0),
            heading=90.0 - element.number_of("referenceHeading", default=0.0),
        )
        sensor.position_noise = axis_noises(element)
        sensor.velocity_noise = axis_noises(element, "velocity")
        return (sensor,)


class HectorImu(Plugin):
    """``libhector_gazebo_ros_imu.so``: an IMU on the link ``bodyName``, with its own errors for each axis."""

    names = ("hector_gazebo_ros_imu",)
    unused = ("serviceName", "biasTopic", "headingOffset", "headingDrift", "headingGaussianNoise")

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Yield the sensor."""
        element = description.element
        xyz = element.vector_of("xyzOffset", size=3, default=(0.0, 0.0, 0.0))
        rpy = element.vector_of("rpyOffset", size=3, default=(0.0, 0.0, 0.0))
        sensor = Imu(*_carrier(description, context, "imu", pose=Pose.from_xyz_rpy(xyz, rpy)))
        _name(sensor, PluginParameters(description, context), "imu")
        sensor.rate_noise = axis_noises(element, "rate")
        sensor.acceleration_noise = axis_noises(element, "accel")
        return (sensor,)


class HectorMagnetometer(Plugin):
    """``libhector_gazebo_ros_magnetic.so``: the world's magnetic field at the link ``bodyName``."""

    names = ("hector_gazebo_ros_magnetic",)

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Yield the sensor."""
        sensor = Magnetometer(*_carrier(description, context, "magnetometer"))
        _name(sensor, PluginParameters(description, context), "magnetic")
        sensor.field_noise = axis_noises(description.element)
        return (sensor,)


def axis_noises(element: Element, of: str = "") -> tuple[Noise, Noise, Noise]:
    """Read the errors of three axes: offset, noise, and a drift with the inverse of its frequency as time constant.

    Parameters
    ----------
    element : Element
    of : str
        What is in front of the tags, such as ``rate`` in ``rateGaussianNoise``.
    """

    def numbers(words: str) -> tuple[float, ...]:
        child = element.first(of + words if of else words[0].lower() + words[1:])
        if child is None:
            return (0.0, 0.0, 0.0)
        return (child.number(),) * 3 if len(child.text.split()) == 1 else child.vector(3)

    columns = (numbers(words) for words in ("Offset", "GaussianNoise", "Drift", "DriftFrequency"))
    x, y, z = (
        Noise(offset, noise, dynamic_bias_stddev=drift, dynamic_bias_correlation_time=1 / rate if rate > 0 else 0.0)
        for offset, noise, drift, rate in zip(*columns, strict=True)
    )
    return x, y, z


def _carrier(
    description: PluginDescription, context: ComponentContext, kind: str, rate: float = 0.0, pose: Pose | None = None
) -> tuple[SensorDescription, ComponentContext]:
    """Return the description and the context of a sensor on the link ``bodyName``, by default the first link."""
    element, parameters = description.element, PluginParameters(description, context)
    link = parameters.require_link("bodyName", "body_name", default=next(iter(context.model.links), ""))
    rate = element.number_of("updateRate", "update_rate", default=rate)
    sensor = SensorDescription(description.name, kind, element, pose=pose or Pose(), update_rate=rate)
    return sensor, replace(context, link=link)


def _name(sensor: Sensor, parameters: PluginParameters, topic: str, frame_id: str = "") -> None:
    element = parameters.element
    sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default=topic))
    default = frame_id or sensor.frame_id
    sensor.frame_id = frame(element.text_of("frameId", "frameName", "frame_name", default=default))
