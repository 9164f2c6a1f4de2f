"""GPS: geographic position and velocity of the sensor."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from daidalos.common.pose3 import rotate
from daidalos.description.markup import Element
from daidalos.description.world import SphericalCoordinates
from daidalos.samples.sensors import NavSatSample, Sample
from daidalos.simulation.geodesy import to_east_north_up, to_geodetic
from daidalos.simulation.noise import Noise
from daidalos.simulation.sensors.noisy import NoisySensor, nested_noise


class NavSat(NoisySensor):
    """Receiver of satellite navigation.

    Attributes
    ----------
    origin : SphericalCoordinates
        Of the world; a plugin may set another.
    position_noise, velocity_noise : tuple of 3 Noise
        In metres and metres a second: horizontally twice, vertically.
    """

    names = ("gps", "navsat")
    default_topic = "navsat"
    sample = NavSatSample

    def read(self, element: Element) -> None:
        """Read the noise; that of positions is in metres."""
        settings = element.first("gps", "navsat") or Element("navsat")
        self.position_noise, self.velocity_noise = (
            tuple(nested_noise(settings, kind, axis) for axis in ("horizontal", "horizontal", "vertical"))
            for kind in ("position_sensing", "velocity_sensing")
        )
        self.origin = self.context.world.spherical_coordinates or SphericalCoordinates()

    @property
    def noises(self) -> tuple[Noise, ...]:
        """Noise of position and velocity."""
        return (*self.position_noise, *self.velocity_noise)

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the position of the sensor."""
        pose = self.link.pose
        linear, angular = self.link.velocity()
        arm = np.array(rotate(pose.orientation, self.pose.position))
        speed = to_east_north_up(linear + np.cross(angular, arm), self.origin)
        measured = self.apply_noise(np.concatenate((np.array(pose.position) + arm, speed)), now_ns)
        place = to_geodetic(measured[:3], self.origin)
        yield NavSatSample(
            stamp_ns=now_ns,
            topic=self.topic,
            frame_id=self.frame_id,
            latitude=place.latitude,
            longitude=place.longitude,
            altitude=place.altitude,
            velocity=measured[3:],
            covariance=np.diag(self.variance[:3]).ravel(),
        )
