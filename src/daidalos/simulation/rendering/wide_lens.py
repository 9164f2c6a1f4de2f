"""Wide-angle lenses: mapping functions from the angle off the optical axis to the place in the picture."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.simulation.rendering.optics import OPTICAL, Pinhole

_FUNCTIONS: dict[str, tuple[Callable[[Array], Array], Callable[[Array], Array], float]] = {
    # The function, its inverse, and the largest argument to which a picture is scaled.
    "sin": (np.sin, np.arcsin, math.pi / 2),
    "tan": (np.tan, np.arctan, math.radians(80.0)),
    "id": (np.positive, np.positive, math.inf),
}
_QUARTER = math.pi / 2
_FACES = ((0.0, 0.0), (0.0, _QUARTER), (0.0, -_QUARTER), (_QUARTER, 0.0), (-_QUARTER, 0.0), (0.0, math.pi))
"""Pitch and yaw of the faces of the environment cube: ahead, left, right, below, above, behind."""
_FIT_ERROR = 0.5
"""Largest error [pixels] with which a camera model describes a lens."""


@dataclass(frozen=True)
class Mapping:
    """Mapping function r = c1 f fun(theta / c2 + c3), as in SDF's ``<custom_function>``.

    Parameters
    ----------
    c1, c2, c3 : float
    f : float
        Focal length; r = 1 is half the width of the picture.
    fun : str
        ``sin``, ``tan`` or ``id``.
    """

    c1: float = 1.0
    c2: float = 1.0
    c3: float = 0.0
    f: float = 1.0
    fun: str = "tan"

    @property
    def widest(self) -> float:
        """Largest angle off the axis [rad] to which a picture can be scaled."""
        return (_FUNCTIONS[self.fun][2] - self.c3) * self.c2

    def radius(self, angle: Array) -> Array:
        """Return the distances from the middle, in half widths, of angles off the axis [rad]."""
        return self.c1 * self.f * _FUNCTIONS[self.fun][0](angle / self.c2 + self.c3)

    def angle(self, radius: Array) -> Array:
        """Return the angles off the axis [rad] of distances from the middle; NaN where nothing is mapped to."""
        with np.errstate(invalid="ignore"):
            return (_FUNCTIONS[self.fun][1](radius / (self.c1 * self.f)) - self.c3) * self.c2

    def scaled(self, angle: float) -> Mapping:
        """Return the function whose f maps an angle off the axis [rad] to half the width."""
        unscaled = replace(self, f=1.0)
        return replace(self, f=1.0 / float(unscaled.radius(np.array(angle))))


MAPPINGS = {
    "gnomonical": Mapping(),
    "stereographic": Mapping(c1=2.0, c2=2.0),
    "equidistant": Mapping(fun="id"),
    "equisolid_angle": Mapping(c1=2.0, c2=2.0, fun="sin"),
    "orthographic": Mapping(fun="sin"),
}
"""Mapping functions by SDF's names of lens types."""
FUNCTIONS = tuple(_FUNCTIONS)
"""Names of the functions of a custom mapping."""


@dataclass(frozen=True, eq=False)
class Face:
    """Part of a side of the environment cube that a lens shows.

    Parameters
    ----------
    pose : Pose
        In the sensor; x ahead, z up.
    pinhole : Pinhole
        Of the side, cut to what the lens shows.
    pixels : array (n,) of int
        Indices of the picture's pixels, row by row, that show this side.
    places : array (1, n, 2) of float32
        Column and row in the side's picture of each of these pixels.
    """

    pose: Pose
    pinhole: Pinhole
    pixels: NDArray[np.intp]
    places: NDArray[np.float32]


@dataclass(frozen=True)
class WideLens:
    """Camera with a mapping function; its principal point is in the middle, as `Pinhole.from_field_of_view`'s.

    Parameters
    ----------
    width, height : int
        [pixels].
    mapping : Mapping
    cutoff : float
        Angle off the axis [rad] beyond which the picture is black.
    texture : int
        Pixels a side of the environment cube.
    """

    width: int
    height: int
    mapping: Mapping
    cutoff: float = _QUARTER
    texture: int = 256

    @cached_property
    def rays(self) -> Array:
        """Unit vectors (height, width, 3) in the optical frame that the pixels show; NaN for black ones."""
        columns, rows = np.meshgrid(np.arange(self.width, dtype=float), np.arange(self.height, dtype=float))
        x, y = columns - self.width / 2, rows - self.height / 2
        radius = np.hypot(x, y)
        angle = self.mapping.angle(radius / (self.width / 2))
        angle[~(np.abs(angle) <= min(self.cutoff, math.pi))] = np.nan
        across = np.sin(angle) / np.where(radius > 0, radius, 1.0)
        return np.stack((x * across, y * across, np.cos(angle)), axis=-1)

    @cached_property
    def faces(self) -> list[Face]:
        """Sides of the environment cube that the lens shows."""
        rays = self.rays.reshape(-1, 3)
        turns = [Pose(orientation=quaternion_from_rpy(0.0, pitch, yaw)) for pitch, yaw in _FACES]
        axes = [OPTICAL.matrix[:3, :3].T @ (turn @ OPTICAL).matrix[:3, :3] for turn in turns]
        ahead = np.stack([rays @ axis[:, 2] for axis in axes], axis=1)
        nearest = np.where(np.isfinite(ahead[:, 0]), np.nan_to_num(ahead).argmax(axis=1), -1)
        faces = []
        for number, (turn, axis) in enumerate(zip(turns, axes, strict=True)):
            pixels = np.flatnonzero(nearest == number)
            if not len(pixels):
                continue
            seen = rays[pixels] @ axis
            focal = self.texture / 2
            places = focal * seen[:, :2] / seen[:, 2:]
            first = np.floor(places.min(axis=0)) - 1
            size = np.ceil(places.max(axis=0)) - first + 2
            pinhole = Pinhole(int(size[0]), int(size[1]), focal, focal, -float(first[0]), -float(first[1]))
            faces.append(Face(turn, pinhole, pixels, (places - first).astype(np.float32)[None]))
        return faces

    @cached_property
    def calibration(self) -> tuple[str, tuple[float, ...], Array]:
        """Distortion model, its coefficients and the matrix K (3, 3) that describe the lens within half a pixel.

        The model is ROS's ``plumb_bob`` without distortion for a gnomonical lens, and ``equidistant`` (J. Kannala and
        S. Brandt, "A generic camera model and calibration method for conventional, wide-angle, and fish-eye lenses",
        2006) for others; without a name, and with a matrix of zeros, where neither describes the lens.
        """
        mapping, half = self.mapping, self.width / 2
        widest = float(np.nanmax(np.append(np.arccos(np.clip(self.rays[..., 2], -1.0, 1.0)), 0.0)))
        angles = np.linspace(0.0, widest, 257)[1:]
        slope = 1e-6
        focal = half * float(mapping.radius(np.array(slope)) - mapping.radius(np.array(0.0))) / slope
        matrix = np.array(((focal, 0.0, half), (0.0, focal, self.height / 2), (0.0, 0.0, 1.0)))
        if mapping.fun == "tan" and mapping.c2 == 1.0 and mapping.c3 == 0.0:
            return "plumb_bob", (0.0,) * 5, matrix
        wanted = half * mapping.radius(angles)
        terms = focal * angles[:, None] ** np.array((3, 5, 7, 9))
        scale = np.abs(terms).max(axis=0)
        coefficients = np.linalg.lstsq(terms / scale, wanted - focal * angles, rcond=None)[0] / scale
        if not np.abs(focal * angles + terms @ coefficients - wanted).max() <= _FIT_ERROR:
            return "", (), np.zeros((3, 3))
        return "equidistant", tuple(np.where(np.abs(coefficients) < 1e-9, 0.0, coefficients).tolist()), matrix
