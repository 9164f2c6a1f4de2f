"""Rays of a lidar against the world's shapes, sector by sector."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.simulation.conversion.geometry import RAY_GROUPS
from daidalos.simulation.physics import Physics

BODIES_PER_SECTOR = 30
"""Bodies in the world for which another sector is worth its call of MuJoCo."""
MAX_SECTORS = 8
_MARGIN = 1e-6
"""Distance and angle by which shapes count as larger, for what rounding makes of them [m, rad]."""
_TINY = 1e-12


class RayFan:
    """Rays from one point, in rings of equal azimuths.

    MuJoCo tests each ray against the bounding sphere of each body. Bodies that no ray of a sector can hit are left out
    here, once for all its rays, so that the work grows with what is near each ray and not with the whole world.

    Parameters
    ----------
    azimuths : array (columns,)
        Rising by even steps [rad].
    elevations : array (rings,)
        [rad].

    Attributes
    ----------
    directions : array (rings * columns, 3)
        Unit vectors, ring by ring.
    """

    def __init__(self, azimuths: Array, elevations: Array) -> None:
        up, turn = np.meshgrid(elevations, azimuths, indexing="ij")
        vectors = np.stack((np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)), axis=-1)
        self.directions: Array = vectors.reshape(-1, 3)
        self._azimuths = azimuths
        self._is_plane = not elevations.any()
        self._shape = len(elevations), len(azimuths)

    def bind(self, model: Any) -> None:
        """Find the shapes that stop rays in a compiled model, and divide the rays into sectors."""
        self._counts = np.array(model.body_geomnum)
        self._trees = np.array(model.body_bvhadr)
        self._bodies = np.flatnonzero(self._counts)
        self._first_geoms = np.array(model.body_geomadr)[self._bodies]
        reach = np.array(model.geom_rbound)
        self._reach = np.where(reach > 0, reach + _MARGIN, np.inf)  # 0 is that of infinite shapes
        self._stops = RAY_GROUPS[model.geom_group] > 0
        rings, columns = self._shape
        wanted = min(max(1, len(self._bodies) // BODIES_PER_SECTOR), MAX_SECTORS, columns)
        parts = np.array_split(np.arange(columns), wanted)
        numbers = np.arange(rings * columns).reshape(rings, columns)
        self._sectors = [numbers[:, part].ravel() for part in parts]
        ends = np.array([(self._azimuths[part[0]], self._azimuths[part[-1]]) for part in parts])
        self._centres, self._widths = ends.mean(axis=1), np.ptp(ends, axis=1) / 2 + _MARGIN

    def cast(
        self, physics: Physics, origin: Array, rotation: Array, body: int, cutoff: float
    ) -> tuple[Array, NDArray[np.int32]]:
        """Return the distance of what each ray hits first [m], and the geom; -1 where it hits nothing.

        Parameters
        ----------
        physics : Physics
            With fresh positions.
        origin : array (3,)
            In the world.
        rotation : array (3, 3)
            Of the sensor in the world.
        body : int
            Whose own shapes are left out.
        cutoff : float
            Distance from which on shapes are not looked for [m].
        """
        model, data = physics.model, physics.data
        rays = np.ascontiguousarray(self.directions @ rotation.T)
        if len(self._sectors) == 1:
            return _cast(model, data, origin, rays, body, cutoff)
        distances, geoms = np.empty(len(rays)), np.empty(len(rays), dtype=np.int32)
        counts, trees = np.zeros_like(self._counts), np.full_like(self._trees, -1)
        try:
            for sector, near in zip(self._sectors, self._bodies_near(data, origin, rotation, cutoff), strict=True):
                counts[:], trees[:] = 0, -1
                counts[near], trees[near] = self._counts[near], self._trees[near]
                model.body_geomnum[:], model.body_bvhadr[:] = counts, trees
                distances[sector], geoms[sector] = _cast(model, data, origin, rays[sector], body, cutoff)
        finally:
            model.body_geomnum[:], model.body_bvhadr[:] = self._counts, self._trees
        return distances, geoms

    def _bodies_near(self, data: Any, origin: Array, rotation: Array, cutoff: float) -> list[NDArray[np.intp]]:
        """Return for each sector the bodies with a shape whose bounding sphere reaches into it."""
        places = (data.geom_xpos - origin) @ rotation
        across = np.hypot(places[:, 0], places[:, 1])
        possible = self._stops & (across <= self._reach + cutoff)
        if self._is_plane:
            possible &= np.abs(places[:, 2]) <= self._reach
        spread = np.where(across > self._reach, np.arcsin(np.minimum(self._reach / (across + _TINY), 1.0)), np.pi)
        azimuths = np.arctan2(places[:, 1], places[:, 0])
        away = np.abs((azimuths - self._centres[:, None] + np.pi) % (2 * np.pi) - np.pi)
        inside = possible & (away <= spread + self._widths[:, None])
        of_bodies = np.logical_or.reduceat(inside, self._first_geoms, axis=1)
        return [self._bodies[row] for row in of_bodies]


def _cast(
    model: Any, data: Any, origin: Array, rays: Array, body: int, cutoff: float
) -> tuple[Array, NDArray[np.int32]]:
    count = len(rays)
    distances, geoms = np.empty(count), np.empty(count, dtype=np.int32)
    mujoco.mj_multiRay(model, data, origin, rays.ravel(), RAY_GROUPS, True, body, geoms, distances, None, count, cutoff)
    return distances, geoms
