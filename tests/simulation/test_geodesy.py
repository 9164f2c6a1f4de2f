import numpy as np
import pytest

from daidalos.description.world import SphericalCoordinates
from daidalos.simulation.geodesy import to_geodetic


def test_the_origin_is_where_the_world_says():
    place = to_geodetic(np.zeros(3), SphericalCoordinates(49.9, 8.9, 143.0))
    assert (place.latitude, place.longitude, place.altitude) == pytest.approx((49.9, 8.9, 143.0), abs=1e-9)


@pytest.mark.parametrize("latitude", [0.0, 45.0, -70.0])
def test_steps_north_and_east_follow_the_radii_of_curvature(latitude):
    """Meridian and prime vertical radii of WGS 84 (closed forms)."""
    a, e2 = 6378137.0, 0.00669437999014
    root = np.sqrt(1 - e2 * np.sin(np.radians(latitude)) ** 2)
    meridian, prime = a * (1 - e2) / root**3, a / root
    origin = SphericalCoordinates(latitude, 10.0)
    north, east = to_geodetic(np.array((0, 10.0, 0)), origin), to_geodetic(np.array((10.0, 0, 0)), origin)
    assert np.radians(north.latitude - latitude) * meridian == pytest.approx(10, abs=1e-4)
    assert np.radians(east.longitude - 10) * prime * np.cos(np.radians(latitude)) == pytest.approx(10, abs=1e-4)


def test_the_heading_turns_the_worlds_axes():
    """Heading 90: the world's x axis points north."""
    place = to_geodetic(np.array((100.0, 0, 0)), SphericalCoordinates(10.0, 20.0, heading=90.0))
    assert place.latitude > 10.0009
    assert place.longitude == pytest.approx(20.0, abs=1e-9)
