"""ROS 1's GPS plugin."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.pose import Pose
from daidalos.description.world import SphericalCoordinates
from daidalos.simulation.component import Component, Setting
from daidalos.simulation.noise import Noise
from daidalos.simulation.plugins.base import Parameters, Plugin
from daidalos.simulation.sensors.navsat import NavSat
from daidalos.simulation.topics import frame


class GpsOfModel(Plugin):
    """``libhector_gazebo_ros_gps.so``: a receiver on the link ``bodyName``, without a ``<sensor>``.

    ``offset`` and ``gaussianNoise`` are in metres along the world's axes; ``referenceHeading`` is where x points
    by compass [deg].
    """

    names = ("hector_gazebo_ros_gps",)

    @classmethod
    def make(cls, description: PluginDescription, setting: Setting) -> Iterable[Component]:
        """Make the sensor itself."""
        parameters = Parameters(description, setting)
        element = description.element
        links = setting.model.links
        link = parameters.scoped(element.text_of("bodyName", "body_name", default=next(iter(links), "")))
        if link not in links:
            known = ", ".join(links)
            raise element.error(f"<bodyName> is {link!r}, expected one of the links {known}")
        sensor = NavSat(
            SensorDescription(
                name=description.name,
                type="navsat",
                element=element,
                pose=Pose(),
                update_rate=element.number_of("updateRate", "update_rate", default=4.0),
            ),
            link,
            setting,
        )
        sensor.topic = parameters.topic(element.text_of("topicName", "topic_name", default="fix"))
        sensor.frame_id = frame(element.text_of("frameId", "frameName", "frame_name", default="world"))
        sensor.origin = SphericalCoordinates(
            latitude=element.number_of("referenceLatitude", default=49.9),
            longitude=element.number_of("referenceLongitude", default=8.9),
            elevation=element.number_of("referenceAltitude", default=0.0),
            heading=90.0 - element.number_of("referenceHeading", default=0.0),
        )
        spreads = element.vector_of("gaussianNoise", size=3, default=(0.0, 0.0, 0.0))
        shifts = element.vector_of("offset", size=3, default=(0.0, 0.0, 0.0))
        sensor.position_noise = tuple(
            Noise(mean=shift, stddev=spread) for shift, spread in zip(shifts, spreads, strict=True)
        )
        return (sensor,)
