"""Ground-truth map of a world: its static collision geometry cut at one height, as a raster."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.geometry import Empty, Heightmap, Plane
from daidalos.description.meshes import TriangleMesh, triangles_of
from daidalos.description.world import World


@dataclass(frozen=True, eq=False)
class Footprint:
    """Raster of the cells that are inside static collision geometry.

    Parameters
    ----------
    occupied : array (rows, columns) of bool
        Cell (r, c) covers x from ``origin[0] + c * resolution`` and y from ``origin[1] + r * resolution``;
        it is true where the cell's centre is inside.
    resolution : float
        Side of a cell [m].
    origin : tuple of 2 floats
        The lower left corner in the world [m].
    """

    occupied: NDArray[np.bool_]
    resolution: float
    origin: tuple[float, float]

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Return row and column of a point, which may lie outside."""
        column = int(np.floor((x - self.origin[0]) / self.resolution))
        return int(np.floor((y - self.origin[1]) / self.resolution)), column

    def reachable(self, x: float, y: float) -> NDArray[np.bool_]:
        """Return the free cells that are 4-connected with a point."""
        from scipy import ndimage

        row, column = self.cell(x, y)
        rows, columns = self.occupied.shape
        if not (0 <= row < rows and 0 <= column < columns) or self.occupied[row, column]:
            return np.zeros_like(self.occupied)
        labels, _ = ndimage.label(~self.occupied)
        connected: NDArray[np.bool_] = labels == labels[row, column]
        return connected

    def visible_walls(self, x: float, y: float) -> NDArray[np.bool_]:
        """Return the occupied cells that are visible from any cell reachable from a point.

        These are the cells of solids that touch the free space around the point, corners included;
        the inside of walls and what lies behind them is not among them.
        """
        from scipy import ndimage

        touched = ndimage.binary_dilation(self.reachable(x, y), np.ones((3, 3), dtype=bool))
        walls: NDArray[np.bool_] = self.occupied & touched
        return walls


def footprint(world: World, height: float, resolution: float = 0.05, margin: float = 0.5) -> Footprint:
    """Compute the raster of a world's static models at one height.

    Parameters
    ----------
    world : World
    height : float
        Of the cut above the world's origin [m], such as that of a lidar.
    resolution : float
        Side of a cell [m].
    margin : float
        Free border around everything [m].

    Returns
    -------
    Footprint
        Planes and heightmaps, which have no inside, are left out.

    Raises
    ------
    DescriptionError
        When a collision mesh is missing or cannot be read.
    """
    cuts = [segments for segments in _cuts(world, height) if len(segments)]
    points = np.concatenate(cuts).reshape(-1, 2) if cuts else np.zeros((1, 2))
    lower = np.floor((points.min(axis=0) - margin) / resolution) * resolution
    shape = np.ceil((points.max(axis=0) + margin - lower) / resolution).astype(int)
    occupied = np.zeros((shape[1], shape[0]), dtype=bool)
    for segments in cuts:
        _fill(occupied, (segments - lower) / resolution)
    return Footprint(occupied, resolution, (float(lower[0]), float(lower[1])))


def _cuts(world: World, height: float) -> list[Array]:
    """Return each static collision's outline at the height, as segments (n, 2, 2) in x and y."""
    return [
        _outline(triangles_of(collision.geometry), model.pose @ link.pose @ collision.pose, height)
        for model in world.models
        if model.static
        for link in model.links.values()
        for collision in link.collisions
        if not isinstance(collision.geometry, Plane | Heightmap | Empty)
    ]


def _outline(mesh: TriangleMesh, pose: Pose, height: float) -> Array:
    """Intersect triangles with the horizontal plane; vertices on the plane count as above it."""
    vertices = mesh.vertices @ rotation_matrix(pose.orientation).T + pose.position
    corners = vertices[mesh.faces]
    above = corners[:, :, 2] >= height
    crossed = corners[above.any(axis=1) & ~above.all(axis=1)]
    above = crossed[:, :, 2] >= height
    # Turn each triangle so that its first corner is alone on its side of the plane.
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), above.argmin(axis=1))
    order = (alone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(crossed, order[:, :, None], axis=1).transpose(1, 0, 2)
    return np.stack((_at_height(a, b, height), _at_height(a, c, height)), axis=1)


def _at_height(a: Array, b: Array, height: float) -> Array:
    """Return x and y where the lines from `a` to `b` cross the height."""
    t = (height - a[:, 2]) / (b[:, 2] - a[:, 2])
    crossing: Array = a[:, :2] + t[:, None] * (b[:, :2] - a[:, :2])
    return crossing


def _fill(occupied: NDArray[np.bool_], segments: Array) -> None:
    """Set the cells whose centre is inside an outline, by the even-odd rule along each row.

    `segments` (n, 2, 2) are in cells. A segment counts for a row when the row's centre line is in the
    half-open span of its y, so that a shared corner counts once.
    """
    (x0, y0), (x1, y1) = segments[:, 0].T, segments[:, 1].T
    rows, columns = occupied.shape
    first = np.ceil(np.minimum(y0, y1) - 0.5).astype(int)
    last = np.ceil(np.maximum(y0, y1) - 0.5).astype(int)
    inside = np.zeros_like(occupied)
    for row in range(max(0, first.min(initial=rows)), min(rows, last.max(initial=0))):
        crossing = (first <= row) & (row < last)
        y = row + 0.5
        t = (y - y0[crossing]) / (y1[crossing] - y0[crossing])
        xs = np.sort(x0[crossing] + t * (x1[crossing] - x0[crossing]))
        edges = np.clip(np.ceil(xs - 0.5).astype(int), 0, columns)
        toggles = np.zeros(columns + 1, dtype=np.int64)
        np.add.at(toggles, edges, 1)
        inside[row] = np.cumsum(toggles)[:columns] % 2 == 1
    occupied |= inside
