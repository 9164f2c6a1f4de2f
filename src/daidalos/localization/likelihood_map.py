"""Likelihood maps: occupancy and the distance of each cell to the nearest obstacle."""

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.localization.errors import LocalizationError
from daidalos.mapping.grid import OccupancyGrid

OCCUPIED_FROM = 65
FREE_UP_TO = 25
"""Values of an occupancy grid that are an obstacle, and that are free."""


class LikelihoodMap:
    """Distances to obstacles in a map.

    Parameters
    ----------
    grid : OccupancyGrid
        The map.
    max_distance : float
        Distances [m] are cut off at this.

    Attributes
    ----------
    distance : ndarray of float32, shape (height, width)
        Distance [m] between the centres of a cell and the nearest occupied one.
    resolution : float
        Side of a cell [m].
    origin : ndarray, shape (2,)
        Position [m] of the outer corner of cell (0, 0).

    Raises
    ------
    LocalizationError
        The map is turned, or has no free cell or no obstacle.
    """

    def __init__(self, grid: OccupancyGrid, max_distance: float) -> None:
        from scipy.ndimage import distance_transform_edt

        if grid.origin[2] != 0.0:
            raise LocalizationError(f"the map is turned by {grid.origin[2]} rad; only maps along the axes are used")
        occupied = grid.data >= OCCUPIED_FROM
        free = (grid.data >= 0) & (grid.data <= FREE_UP_TO)
        if not occupied.any() or not free.any():
            what = "obstacle" if free.any() else "free cell"
            raise LocalizationError(f"the map has no {what}, so no pose in it can be told from another")
        metres = distance_transform_edt(~occupied) * grid.resolution
        self.distance: NDArray[np.float32] = np.minimum(metres, max_distance).astype(np.float32)
        self.max_distance = float(max_distance)
        self.resolution = float(grid.resolution)
        self.origin: Array = np.array(grid.origin[:2], dtype=np.float64)
        self._free = np.argwhere(free)

    def draw_poses(self, count: int, generator: np.random.Generator) -> Array:
        """Draw poses (count, 3) evenly over the free cells and all headings."""
        cells = self._free[generator.integers(self._free.shape[0], size=count)]
        inside = cells[:, ::-1] + generator.random((count, 2))
        yaw = generator.uniform(-np.pi, np.pi, count)
        return np.concatenate([self.origin + self.resolution * inside, yaw[:, None]], axis=1)
