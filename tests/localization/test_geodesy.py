"""Projections of latitude and longitude, against values of PROJ."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.localization.errors import LocalizationError
from daidalos.localization.geodesy import TangentPlane, UtmZone

PLACES = [
    (55.944904, -3.186693, 30, True, 488339.814030069, 6199963.318127835, -0.15467522351511764),
    (-33.8568, 151.2153, 56, False, 334900.56965226424, 6252288.752888294, 0.9945154322862049),
    (60.39, 5.32, 32, True, 297230.2202096259, 6700510.175253601, -3.2005031380617734),
    (78.22, 15.65, 33, True, 514813.5272637488, 8683004.153277192, 0.6363113012912933),
    (0.0, -78.5, 17, True, 778276.3168286406, 0.0, 0.0),
    (47.0, 11.9999, 32, True, 728061.9632259774, 5209532.556767863, 2.194929455596331),
]


@pytest.mark.parametrize(("latitude", "longitude", "number", "is_north", "x", "y", "convergence"), PLACES)
def test_places_have_the_coordinates_of_proj(
    latitude: float, longitude: float, number: int, is_north: bool, x: float, y: float, convergence: float
) -> None:
    zone = UtmZone.containing(latitude, longitude)
    assert zone == UtmZone(number, is_north)
    assert zone.forward(latitude, longitude, 3.0) == pytest.approx((x, y, 3.0), abs=1e-5)
    assert zone.reverse(x, y, 3.0) == pytest.approx((latitude, longitude, 3.0), abs=1e-9)
    assert math.degrees(zone.convergence(latitude, longitude)) == pytest.approx(convergence, abs=1e-7)


def test_a_zone_reaches_over_its_border() -> None:
    """A robot that crosses a border stays in its zone, so its position does not jump."""
    x, y, _ = UtmZone(32, True).forward(47.0, 12.5, 0.0)
    assert (x, y) == pytest.approx((766078.1158426771, 5211111.332420277), abs=1e-5)


@pytest.mark.parametrize(("text", "zone"), [("31U", UtmZone(31, True)), ("56h", UtmZone(56, False))])
def test_zones_are_read(text: str, zone: UtmZone) -> None:
    assert UtmZone.parse(text) == zone


@pytest.mark.parametrize("text", ["", "61U", "31I", "31", "U31"])
def test_what_is_no_zone_is_refused(text: str) -> None:
    with pytest.raises(LocalizationError, match="expected a zone of UTM such as '31U'"):
        UtmZone.parse(text)
    with pytest.raises(LocalizationError, match=r"latitude 85\.000 is outside UTM"):
        UtmZone.containing(85.0, 0.0)


def test_the_tangent_plane_is_that_of_proj() -> None:
    plane = TangentPlane(55.944904, -3.186693)
    point = (1042.8863597193572, 567.5296277580045, 119.88969258643539)
    assert plane.forward(55.95, -3.17, 120.0) == pytest.approx(point, abs=1e-6)


@given(st.floats(-79.9, 83.9), st.floats(-180.0, 179.99), st.floats(-100.0, 9000.0))
def test_forward_and_reverse_are_inverse(latitude: float, longitude: float, altitude: float) -> None:
    for projection in (UtmZone.containing(latitude, longitude), TangentPlane(latitude, longitude)):
        back = projection.reverse(*projection.forward(latitude, longitude, altitude))
        assert back[0] == pytest.approx(latitude, abs=1e-8)
        assert math.remainder(back[1] - longitude, 360.0) == pytest.approx(0.0, abs=1e-7)
        assert back[2] == pytest.approx(altitude, abs=1e-5)
