"""Pinhole camera model with lens distortion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, quaternion_from_rpy

OPTICAL = Pose(orientation=quaternion_from_rpy(-math.pi / 2, 0.0, -math.pi / 2))
"""Optical frame (z ahead, x right, y down) in a sensor's frame (x ahead, y left, z up)."""


@dataclass(frozen=True)
class Pinhole:
    """Pinhole camera; the centre of the pixel in column i is at i.

    Parameters
    ----------
    width, height : int
        [pixels].
    fx, fy, cx, cy : float
        Focal lengths and principal point [pixels].
    distortion : tuple of 5 floats
        k1, k2, p1, p2, k3 of the plumb bob model (D. C. Brown, "Decentering distortion of lenses", 1966).
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)

    @classmethod
    def from_field_of_view(cls, width: int, height: int, field_of_view: float) -> Pinhole:
        """Return the camera with a horizontal field of view [rad] and square pixels, as in Gazebo."""
        focal = width / (2 * math.tan(field_of_view / 2))
        return cls(width, height, focal, focal, width / 2, height / 2)

    @property
    def is_distorted(self) -> bool:
        """Whether the lens distorts."""
        return any(self.distortion)

    @property
    def matrix(self) -> Array:
        """Intrinsic matrix K (3, 3)."""
        return np.array(((self.fx, 0.0, self.cx), (0.0, self.fy, self.cy), (0.0, 0.0, 1.0)))

    @property
    def lens(self) -> Array:
        """Focal lengths and principal point (4,)."""
        return np.array((self.fx, self.fy, self.cx, self.cy))

    @property
    def rays(self) -> NDArray[np.float32]:
        """Ray of each pixel (height, width, 3), of length 1 along the optical axis."""
        x, y = self._ideal_rays
        return np.stack((x, y, np.ones_like(x)), axis=-1).astype(np.float32)

    def project(self, points: Array) -> Array:
        """Return the pixels (n, 2) of points (n, 3) in the optical frame, with distortion."""
        x, y = self._distorted(points[:, 0] / points[:, 2], points[:, 1] / points[:, 2])
        return np.stack((self.fx * x + self.cx, self.fy * y + self.cy), axis=1)

    @cached_property
    def ideal(self) -> Pinhole:
        """Camera without distortion whose view contains this camera's, at the same resolution."""
        if not self.is_distorted:
            return self
        x, y = self._ideal_rays
        left, right = max(0, math.ceil(-(x.min() * self.fx))), max(0, math.ceil(x.max() * self.fx))
        top, bottom = max(0, math.ceil(-(y.min() * self.fy))), max(0, math.ceil(y.max() * self.fy))
        return Pinhole(left + right + 3, top + bottom + 3, self.fx, self.fy, left + 1.0, top + 1.0)

    @cached_property
    def lookup(self) -> NDArray[np.float32]:
        """Position of each pixel in the picture of `ideal` (height, width, 2): column and row."""
        x, y = self._ideal_rays
        ideal = self.ideal
        return np.stack((ideal.fx * x + ideal.cx, ideal.fy * y + ideal.cy), axis=-1).astype(np.float32)

    @cached_property
    def _ideal_rays(self) -> tuple[Array, Array]:
        """Return x / z and y / z of each pixel's ray by fixed-point inversion of the distortion."""
        columns, rows = np.meshgrid(np.arange(self.width, dtype=np.float64), np.arange(self.height, dtype=np.float64))
        goal_x: Array = (columns - self.cx) / self.fx
        goal_y: Array = (rows - self.cy) / self.fy
        if not self.is_distorted:
            return goal_x, goal_y
        x, y = goal_x.copy(), goal_y.copy()
        for _ in range(50):
            now_x, now_y = self._distorted(x, y)
            x, y = x + goal_x - now_x, y + goal_y - now_y
        limit = 4.0 * max(self.width / self.fx, self.height / self.fy)
        return np.clip(np.nan_to_num(x), -limit, limit), np.clip(np.nan_to_num(y), -limit, limit)

    def _distorted(self, x: Array, y: Array) -> tuple[Array, Array]:
        k1, k2, p1, p2, k3 = self.distortion
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )
