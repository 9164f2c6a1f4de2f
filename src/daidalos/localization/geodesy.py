"""Projections of latitude and longitude (WGS84) onto planes: zones of UTM, and the tangent plane of a place."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from daidalos.common.arrays import Array
from daidalos.localization.errors import LocalizationError

_A = 6378137.0
_F = 1.0 / 298.257223563
_E2 = _F * (2.0 - _F)
_E = math.sqrt(_E2)
_N = _F / (2.0 - _F)
_SCALE, _FALSE_EASTING, _FALSE_NORTHING = 0.9996, 500_000.0, 10_000_000.0
_RADIUS = _SCALE * _A / (1.0 + _N) * (1.0 + _N**2 / 4.0 + _N**4 / 64.0)
_ALPHA = (
    _N / 2.0 - 2.0 * _N**2 / 3.0 + 5.0 * _N**3 / 16.0 + 41.0 * _N**4 / 180.0,
    13.0 * _N**2 / 48.0 - 3.0 * _N**3 / 5.0 + 557.0 * _N**4 / 1440.0,
    61.0 * _N**3 / 240.0 - 103.0 * _N**4 / 140.0,
    49561.0 * _N**4 / 161280.0,
)
_BETA = (
    _N / 2.0 - 2.0 * _N**2 / 3.0 + 37.0 * _N**3 / 96.0 - _N**4 / 360.0,
    _N**2 / 48.0 + _N**3 / 15.0 - 437.0 * _N**4 / 1440.0,
    17.0 * _N**3 / 480.0 - 37.0 * _N**4 / 840.0,
    4397.0 * _N**4 / 161280.0,
)
"""Coefficients of Krueger's series, in which the ellipsoid becomes a plane (Karney 2011, equations 35 and 36)."""

_SOUTH_END, _NORTH_END = -80.0, 84.0
_ZONE = re.compile(r"(\d{1,2})([C-HJ-NP-X])", re.IGNORECASE)
_NEWTON_STEPS = 6


class Projection(Protocol):
    """Plane with x to the east and y to the north."""

    def forward(self, latitude: float, longitude: float, altitude: float) -> tuple[float, float, float]:
        """Return x, y, z [m] of a place: latitude and longitude [deg], altitude above the ellipsoid [m]."""

    def reverse(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """Return latitude, longitude [deg] and altitude [m] of a point."""

    def convergence(self, latitude: float, longitude: float) -> float:
        """Return the angle [rad] from true north to the y axis, positive clockwise."""


@dataclass(frozen=True)
class UtmZone:
    """Zone of the universal transverse Mercator projection.

    Attributes
    ----------
    number : int
        1 to 60, from west to east.
    is_north : bool
        Whether y is 0 at the equator, and not 10,000 km.
    """

    number: int
    is_north: bool

    @classmethod
    def containing(cls, latitude: float, longitude: float) -> UtmZone:
        """Return the zone of a place [deg], with the exceptions of Norway and Svalbard.

        Raises
        ------
        LocalizationError
            When the latitude is outside the zones.
        """
        if not _SOUTH_END <= latitude <= _NORTH_END:
            raise LocalizationError(
                f"latitude {latitude:.3f} is outside UTM ({_SOUTH_END:g} to {_NORTH_END:g}); "
                "the tangent plane (use_local_cartesian) has no such limit"
            )
        east = (longitude + 180.0) % 360.0 - 180.0
        number = int((east + 180.0) // 6.0) + 1
        if 56.0 <= latitude < 64.0 and 3.0 <= east < 12.0:
            number = 32
        elif latitude >= 72.0 and 0.0 <= east < 42.0:
            number = 31 + 2 * int((east + 3.0) // 12.0)
        return cls(number, latitude >= 0.0)

    @classmethod
    def parse(cls, text: str) -> UtmZone:
        """Return a zone from its number and the letter of its band, such as ``31U``.

        Raises
        ------
        LocalizationError
            When it is none.
        """
        found = _ZONE.fullmatch(text.strip())
        if found is None or not 1 <= int(found[1]) <= 60:
            raise LocalizationError(f"expected a zone of UTM such as '31U', found '{text}'")
        return cls(int(found[1]), found[2].upper() >= "N")

    def __str__(self) -> str:
        return f"{self.number} {'north' if self.is_north else 'south'}"

    def forward(self, latitude: float, longitude: float, altitude: float) -> tuple[float, float, float]:
        """Return easting, northing and altitude [m] of a place [deg, m]."""
        conformal = self._conformal(latitude, longitude)
        point = conformal + sum(a * cmath.sin(2 * j * conformal) for j, a in enumerate(_ALPHA, 1))
        north = _RADIUS * point.real + (0.0 if self.is_north else _FALSE_NORTHING)
        return _RADIUS * point.imag + _FALSE_EASTING, north, altitude

    def reverse(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """Return latitude, longitude [deg] and altitude [m] of easting, northing and altitude [m]."""
        point = complex(y - (0.0 if self.is_north else _FALSE_NORTHING), x - _FALSE_EASTING) / _RADIUS
        conformal = point - sum(b * cmath.sin(2 * j * point) for j, b in enumerate(_BETA, 1))
        sine = math.sinh(conformal.imag)
        tangent = math.sin(conformal.real) / math.hypot(sine, math.cos(conformal.real))
        longitude = self._middle + math.atan2(sine, math.cos(conformal.real))
        degrees = (math.degrees(longitude) + 180.0) % 360.0 - 180.0
        return math.degrees(math.atan(_geodetic_tangent(tangent))), degrees, z

    def convergence(self, latitude: float, longitude: float) -> float:
        """Return the angle [rad] from true north to the grid's north at a place [deg], positive clockwise."""
        conformal = self._conformal(latitude, longitude)
        slope = 1.0 + sum(2 * j * a * cmath.cos(2 * j * conformal) for j, a in enumerate(_ALPHA, 1))
        tangent = _conformal_tangent(math.tan(math.radians(latitude)))
        on_sphere = math.atan(tangent / math.hypot(1.0, tangent) * math.tan(self._east(longitude)))
        return on_sphere - cmath.phase(slope)

    @property
    def _middle(self) -> float:
        """Longitude [rad] of the middle meridian."""
        return math.radians(6.0 * self.number - 183.0)

    def _east(self, longitude: float) -> float:
        """Return how far east [rad] of the middle meridian a longitude [deg] is."""
        return math.remainder(math.radians(longitude) - self._middle, math.tau)

    def _conformal(self, latitude: float, longitude: float) -> complex:
        """Return a place in the transverse Mercator projection of the conformal sphere: north + i east."""
        tangent, east = _conformal_tangent(math.tan(math.radians(latitude))), self._east(longitude)
        cosine = math.cos(east)
        return complex(math.atan2(tangent, cosine), math.asinh(math.sin(east) / math.hypot(tangent, cosine)))


def _conformal_tangent(tangent: float) -> float:
    """Return the tangent of the conformal latitude from that of the geodetic one (Karney 2011, equation 7)."""
    sigma = math.sinh(_E * math.atanh(_E * tangent / math.hypot(1.0, tangent)))
    return tangent * math.hypot(1.0, sigma) - sigma * math.hypot(1.0, tangent)


def _geodetic_tangent(conformal: float) -> float:
    """Return the inverse of `_conformal_tangent` by Newton's method (Karney 2011, equation 19)."""
    tangent = conformal / (1.0 - _E2)
    for _ in range(_NEWTON_STEPS):
        found = _conformal_tangent(tangent)
        step = (conformal - found) / math.hypot(1.0, found)
        tangent += step * (1.0 + (1.0 - _E2) * tangent**2) / ((1.0 - _E2) * math.hypot(1.0, tangent))
    return tangent


@dataclass(frozen=True)
class TangentPlane:
    """Plane that touches the ellipsoid at a place.

    Attributes
    ----------
    latitude, longitude : float
        Of the place, which is its origin [deg].
    """

    latitude: float
    longitude: float

    def forward(self, latitude: float, longitude: float, altitude: float) -> tuple[float, float, float]:
        """Return x, y, z [m] of a place [deg, m]."""
        x, y, z = self._axes.T @ (_geocentric(latitude, longitude, altitude) - self._origin)
        return float(x), float(y), float(z)

    def reverse(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """Return latitude, longitude [deg] and altitude [m] of a point [m]."""
        return _geodetic(self._origin + self._axes @ np.array([x, y, z]))

    def convergence(self, latitude: float, longitude: float) -> float:
        """Return 0: at its origin y points to true north."""
        return 0.0

    @property
    def _origin(self) -> Array:
        return _geocentric(self.latitude, self.longitude, 0.0)

    @property
    def _axes(self) -> Array:
        """The directions east, north and up as columns."""
        (sp, sl), (cp, cl) = (
            np.sin(np.radians([self.latitude, self.longitude])),
            np.cos(np.radians([self.latitude, self.longitude])),
        )
        return np.array([[-sl, -sp * cl, cp * cl], [cl, -sp * sl, cp * sl], [0.0, cp, sp]])


def _geocentric(latitude: float, longitude: float, altitude: float) -> Array:
    """Return a place [deg, m] relative to the centre of the earth [m]."""
    phi, east = math.radians(latitude), math.radians(longitude)
    radius = _A / math.sqrt(1.0 - _E2 * math.sin(phi) ** 2)
    across = (radius + altitude) * math.cos(phi)
    up = (radius * (1.0 - _E2) + altitude) * math.sin(phi)
    return np.array([across * math.cos(east), across * math.sin(east), up])


def _geodetic(point: Array) -> tuple[float, float, float]:
    """Return latitude, longitude [deg] and altitude [m] of a point near the surface, by fixed-point iteration."""
    x, y, z = point.tolist()
    across = math.hypot(x, y)
    phi = math.atan2(z, across * (1.0 - _E2))
    for _ in range(_NEWTON_STEPS):
        radius = _A / math.sqrt(1.0 - _E2 * math.sin(phi) ** 2)
        phi = math.atan2(z + _E2 * radius * math.sin(phi), across)
    radius = _A / math.sqrt(1.0 - _E2 * math.sin(phi) ** 2)
    altitude = across * math.cos(phi) + z * math.sin(phi) - radius * (1.0 - _E2 * math.sin(phi) ** 2)
    return math.degrees(phi), math.degrees(math.atan2(y, x)), altitude
