"""Pictures of maps with the way of a robot, georeferenced by a world file, in the colors of RoboCup Rescue."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.mapping.grid import OCCUPIED, UNKNOWN, OccupancyGrid
from daidalos.mapping.map_file import write_together

CHECKER = 1.0
"""Side [m] of the squares behind the map, and distance of the grid's lines."""

FREE_COLOR = (255, 255, 255)
OBSTACLE_COLOR = (0, 40, 120)
LINE_COLOR = (190, 190, 191)
DARK_SQUARE, LIGHT_SQUARE = (226, 226, 227), (237, 237, 238)
WAY_COLOR = (120, 0, 140)
START_COLOR = (255, 200, 0)
START_RADIUS = 0.15
"""Radius [m] of the mark where the way begins."""


@dataclass(frozen=True)
class GeoTiff:
    """A picture of a map.

    Attributes
    ----------
    pixels : ndarray of uint8, shape (rows, columns, 3)
        Red, green and blue; the top row, which has the largest y, first.
    resolution : float
        Side of a pixel [m].
    left, top : float
        Middle of the pixel at the upper left, in the frame of the map [m].
    """

    pixels: NDArray[np.uint8]
    resolution: float
    left: float
    top: float

    @property
    def world(self) -> str:
        """The lines of the world file (ESRI): size and rotation of a pixel, middle of the one at the upper left."""
        numbers = (self.resolution, 0.0, 0.0, -self.resolution, self.left, self.top)
        return "".join(f"{number:.10f}\n" for number in numbers)


def draw_geotiff(
    grid: OccupancyGrid, way: NDArray[np.float64], *, checkerboard: bool = True, free_space_grid: bool = True
) -> GeoTiff:
    """Draw a map without rotation, and the way of a robot through it.

    Parameters
    ----------
    grid
        The map; its origin's yaw is not used.
    way : array (n, 2)
        Places [m] in the frame of the map, the first first; may be empty.
    checkerboard
        Whether squares of 1 m are drawn where nothing is known.
    free_space_grid
        Whether lines at each full meter are drawn where it is free.

    Raises
    ------
    ValueError
        When the map has no cells.
    """
    if grid.data.size == 0:
        raise ValueError("expected a map with cells")
    rows, columns = grid.data.shape
    x = grid.origin[0] + (np.arange(columns) + 0.5) * grid.resolution
    y = grid.origin[1] + (np.arange(rows) + 0.5) * grid.resolution
    square_x, square_y = np.floor(x / CHECKER).astype(int), np.floor(y / CHECKER).astype(int)
    pixels = np.empty((rows, columns, 3), np.uint8)
    pixels[:] = LIGHT_SQUARE
    if checkerboard:
        pixels[(square_x[None, :] + square_y[:, None]) % 2 == 0] = DARK_SQUARE
    free = (grid.data != UNKNOWN) & (grid.data < OCCUPIED // 2)
    pixels[free] = FREE_COLOR
    if free_space_grid:
        on_line = np.zeros((rows, columns), bool)
        on_line[:, 1:] |= np.diff(square_x)[None, :] > 0
        on_line[1:, :] |= np.diff(square_y)[:, None] > 0
        pixels[free & on_line] = LINE_COLOR
    pixels[grid.data >= OCCUPIED // 2] = OBSTACLE_COLOR
    picture = GeoTiff(pixels[::-1].copy(), grid.resolution, float(x[0]), float(y[-1]))
    return _draw_way(picture, way) if len(way) else picture


def _draw_way(picture: GeoTiff, way: NDArray[np.float64]) -> GeoTiff:
    from PIL import Image, ImageDraw

    image = Image.fromarray(picture.pixels)
    draw = ImageDraw.Draw(image)
    places = (way - [picture.left, picture.top]) / [picture.resolution, -picture.resolution]
    points = [(float(column), float(row)) for column, row in places]
    if len(points) > 1:
        draw.line(points, fill=WAY_COLOR)
    column, row = points[0]
    radius = max(1.0, START_RADIUS / picture.resolution)
    draw.ellipse((column - radius, row - radius, column + radius, row + radius), fill=START_COLOR)
    return GeoTiff(np.asarray(image), picture.resolution, picture.left, picture.top)


def write_geotiff(base: Path, picture: GeoTiff) -> tuple[Path, Path]:
    """Write ``BASE.tif`` and its world file ``BASE.tfw``; a failure keeps older ones. Return both.

    Raises
    ------
    MapFileError
        When they cannot be written.
    """
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(picture.pixels).save(file, "TIFF", compression="tiff_lzw")
    image, world = base.with_name(f"{base.name}.tif"), base.with_name(f"{base.name}.tfw")
    write_together({image: file.getvalue(), world: picture.world.encode()})
    return image, world
