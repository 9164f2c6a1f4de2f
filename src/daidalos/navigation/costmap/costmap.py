"""Costmap: a grid of costs from free (0) to lethal (254) with its geometry."""

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.navigation.errors import NavigationError

Costs = NDArray[np.uint8]
T = TypeVar("T", np.uint8, np.uint16)

FREE_SPACE = 0
MAX_NON_OBSTACLE = 252
INSCRIBED_INFLATED_OBSTACLE = 253
LETHAL_OBSTACLE = 254
NO_INFORMATION = 255


class CostmapError(NavigationError):
    """Invalid creation or change of a costmap."""


@dataclass(frozen=True)
class Window:
    """Rectangle of cells: columns [left, right), rows [bottom, top)."""

    left: int
    bottom: int
    right: int
    top: int

    @property
    def empty(self) -> bool:
        """Whether it has no cells."""
        return self.left >= self.right or self.bottom >= self.top

    @property
    def slices(self) -> tuple[slice, slice]:
        """Slices of these cells in an array of rows and columns."""
        return slice(self.bottom, self.top), slice(self.left, self.right)


class Costmap:
    """Costs of square cells in a frame of their own.

    Parameters
    ----------
    costs : ndarray of uint8, shape (height, width)
        `costs[row, column]`; row 0 is at the origin and rows grow with y. 0 is free, 253 is a cell in which
        the robot's centre means contact, 254 is an obstacle, 255 is unknown.
    resolution : float
        Edge of a cell [m].
    origin : array_like, shape (2,)
        Position [m] of the outer corner of cell (0, 0).

    Raises
    ------
    CostmapError
        The array is not a grid of uint8, or the resolution is not a positive number.
    """

    def __init__(self, costs: Costs, resolution: float, origin: tuple[float, float] | Array) -> None:
        if costs.ndim != 2 or costs.dtype != np.uint8:
            raise CostmapError(
                f"costs must be a grid of uint8, not {costs.ndim} axes of {costs.dtype}; convert them first"
            )
        if not (math.isfinite(resolution) and resolution > 0.0):
            raise CostmapError(f"resolution must be a positive length in metres, not {resolution}")
        self.costs = np.ascontiguousarray(costs)
        self.resolution = float(resolution)
        self.origin: Array = np.array(origin, dtype=np.float64).reshape(2)

    @classmethod
    def filled(
        cls,
        width: int,
        height: int,
        resolution: float,
        origin: tuple[float, float] | Array,
        value: int = FREE_SPACE,
    ) -> "Costmap":
        """Return a costmap of one value; width and height are in cells."""
        return cls(np.full((height, width), value, dtype=np.uint8), resolution, origin)

    @property
    def width(self) -> int:
        """Number of columns."""
        return int(self.costs.shape[1])

    @property
    def height(self) -> int:
        """Number of rows."""
        return int(self.costs.shape[0])

    @property
    def window(self) -> Window:
        """Window of all cells."""
        return Window(0, 0, self.width, self.height)

    def world_to_map(self, x: float, y: float) -> tuple[int, int]:
        """Return column and row of a point's cell [m]; they may be outside (see `holds`)."""
        return (
            math.floor((x - self.origin[0]) / self.resolution),
            math.floor((y - self.origin[1]) / self.resolution),
        )

    def map_to_world(self, column: int, row: int) -> tuple[float, float]:
        """Return the position [m] of a cell's centre."""
        return (
            float(self.origin[0] + (column + 0.5) * self.resolution),
            float(self.origin[1] + (row + 0.5) * self.resolution),
        )

    def holds(self, column: int, row: int) -> bool:
        """Return whether a cell is inside."""
        return 0 <= column < self.width and 0 <= row < self.height

    def cost_at(self, x: float, y: float) -> int:
        """Return the cost of the cell at a point [m]; unknown (255) outside."""
        column, row = self.world_to_map(x, y)
        return int(self.costs[row, column]) if self.holds(column, row) else NO_INFORMATION

    def window_of(self, bounds: "Bounds") -> Window:
        """Return the cells that a rectangle [m] touches."""
        if bounds.empty:
            return Window(0, 0, 0, 0)
        left, bottom = self.world_to_map(_finite(bounds.min_x, self.origin[0]), _finite(bounds.min_y, self.origin[1]))
        right, top = self.world_to_map(
            _finite(bounds.max_x, self.origin[0] + self.width * self.resolution),
            _finite(bounds.max_y, self.origin[1] + self.height * self.resolution),
        )
        return Window(
            min(max(left, 0), self.width),
            min(max(bottom, 0), self.height),
            min(max(right + 1, 0), self.width),
            min(max(top + 1, 0), self.height),
        )

    def copy(self) -> "Costmap":
        """Return an independent copy."""
        return Costmap(self.costs.copy(), self.resolution, self.origin.copy())

    def cover(self, width: int, height: int, origin: tuple[float, float] | Array, value: int) -> None:
        """Move and resize the grid; cells keep their position to within half a cell.

        Parameters
        ----------
        width, height : int
            New size in cells.
        origin : array_like, shape (2,)
            New position [m] of the outer corner of cell (0, 0); at a whole number of cells from the present
            one nothing is displaced.
        value : int
            Cost of cells that were not there before.
        """
        wanted = np.array(origin, dtype=np.float64).reshape(2)
        right, up = (round(float(d)) for d in (wanted - self.origin) / self.resolution)
        self.origin = wanted
        if (right, up, width, height) == (0, 0, self.width, self.height):
            return
        self.costs = displaced(self.costs, right, up, (height, width), value)


def displaced(cells: NDArray[T], right: int, up: int, shape: tuple[int, int], value: int) -> NDArray[T]:
    """Return a window of a grid of cells.

    Parameters
    ----------
    cells : ndarray, shape (height, width)
        The grid.
    right, up : int
        Column and row of the grid at which the window begins; they may be outside.
    shape : tuple of int
        Rows and columns of the window.
    value : int
        Value of cells of the window that are outside of the grid.
    """
    moved = np.full(shape, value, dtype=cells.dtype)
    rows = slice(max(up, 0), min(up + shape[0], cells.shape[0]))
    columns = slice(max(right, 0), min(right + shape[1], cells.shape[1]))
    if rows.start < rows.stop and columns.start < columns.stop:
        moved[rows.start - up : rows.stop - up, columns.start - right : columns.stop - right] = cells[rows, columns]
    return moved


@dataclass(frozen=True)
class Bounds:
    """Rectangle of the world [m] that must be updated; empty until something is included."""

    min_x: float = math.inf
    min_y: float = math.inf
    max_x: float = -math.inf
    max_y: float = -math.inf

    @property
    def empty(self) -> bool:
        """Whether it is empty."""
        return self.min_x > self.max_x or self.min_y > self.max_y

    def including(self, other: "Bounds") -> "Bounds":
        """Return the smallest rectangle around both."""
        return Bounds(
            min(self.min_x, other.min_x),
            min(self.min_y, other.min_y),
            max(self.max_x, other.max_x),
            max(self.max_y, other.max_y),
        )

    def including_points(self, points: Array) -> "Bounds":
        """Return the smallest rectangle around this one and points (n, 2)."""
        if points.shape[0] == 0:
            return self
        x, y = points[:, 0], points[:, 1]  # reductions over the short axis would be many times slower
        return self.including(Bounds(float(x.min()), float(y.min()), float(x.max()), float(y.max())))

    def expanded(self, distance: float) -> "Bounds":
        """Return the rectangle expanded by a distance on every side; an empty one stays empty."""
        if self.empty:
            return self
        return Bounds(self.min_x - distance, self.min_y - distance, self.max_x + distance, self.max_y + distance)


EVERYWHERE = Bounds(-math.inf, -math.inf, math.inf, math.inf)
"""Bounds of an update that leaves nothing out."""


def _finite(value: float, otherwise: float) -> float:
    return value if math.isfinite(value) else float(otherwise)
