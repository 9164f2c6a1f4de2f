"""Conversion of world coordinates to geographic ones (WGS 84)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.description.world import SphericalCoordinates

_SEMI_MAJOR = 6378137.0
_FLATTENING = 1 / 298.257223563
_ECCENTRICITY_2 = _FLATTENING * (2 - _FLATTENING)


@dataclass(frozen=True)
class Geodetic:
    """Geographic position: latitude and longitude [deg], height above the ellipsoid [m]."""

    latitude: float
    longitude: float
    altitude: float


def to_east_north_up(vector: Array, origin: SphericalCoordinates) -> Array:
    """Rotate a world vector (3,) to east, north, up at the world's origin."""
    heading = math.radians(origin.heading)
    x, y, z = (float(value) for value in vector)
    return np.array((x * math.cos(heading) - y * math.sin(heading), x * math.sin(heading) + y * math.cos(heading), z))


def to_geodetic(position: Array, origin: SphericalCoordinates) -> Geodetic:
    """Return the geographic position of a world position (3,) [m]."""
    latitude, longitude = math.radians(origin.latitude), math.radians(origin.longitude)
    east, north, up = to_east_north_up(position, origin)
    sp, cp, sl, cl = math.sin(latitude), math.cos(latitude), math.sin(longitude), math.cos(longitude)
    turn = np.array(((-sl, -sp * cl, cp * cl), (cl, -sp * sl, cp * sl), (0.0, cp, sp)))
    return _geodetic(_cartesian(latitude, longitude, origin.elevation) + turn @ np.array((east, north, up)))


def _cartesian(latitude: float, longitude: float, height: float) -> Array:
    across = _SEMI_MAJOR / math.sqrt(1 - _ECCENTRICITY_2 * math.sin(latitude) ** 2)
    flat = (across + height) * math.cos(latitude)
    z = (across * (1 - _ECCENTRICITY_2) + height) * math.sin(latitude)
    return np.array((flat * math.cos(longitude), flat * math.sin(longitude), z))


def _geodetic(point: Array) -> Geodetic:
    """Invert `_cartesian` by fixed-point iteration, which near the surface gains three digits per iteration."""
    x, y, z = (float(value) for value in point)
    flat = math.hypot(x, y)
    latitude, height = math.atan2(z, flat * (1 - _ECCENTRICITY_2)), 0.0
    for _ in range(8):
        across = _SEMI_MAJOR / math.sqrt(1 - _ECCENTRICITY_2 * math.sin(latitude) ** 2)
        # Along the radius where the latitude is small, along the axis near the poles.
        if abs(latitude) < math.pi / 4:
            height = flat / math.cos(latitude) - across
        else:
            height = z / math.sin(latitude) - across * (1 - _ECCENTRICITY_2)
        latitude = math.atan2(z, flat * (1 - _ECCENTRICITY_2 * across / (across + height)))
    return Geodetic(math.degrees(latitude), math.degrees(math.atan2(y, x)), height)
