"""Likelihood maps: the distance of each cell of a map to the nearest obstacle, and tables of values made from it."""

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose2 import between, compose
from daidalos.localization.errors import LocalizationError
from daidalos.mapping.grid import OccupancyGrid

OCCUPIED_FROM = 65
FREE_UP_TO = 25
"""Values of an occupancy grid that are an obstacle, and that are free."""

Table = NDArray[np.float32]


class LikelihoodMap:
    """Distances to obstacles in a map.

    Parameters
    ----------
    grid : OccupancyGrid
        The map; its origin may have any heading.
    max_distance : float
        Distances [m] are cut off at this.
    downsampled : bool
        Whether poses are drawn in every second row and column of cells only.

    Attributes
    ----------
    distance : ndarray of float32, shape (height, width)
        Distance [m] between the centres of a cell and the nearest occupied one.
    resolution : float
        Side of a cell [m].
    origin : ndarray, shape (3,)
        Pose of the outer corner of cell (0, 0) in the map's frame.

    Raises
    ------
    LocalizationError
        The map has no free cell or no obstacle, or its resolution or origin is not usable.
    """

    def __init__(self, grid: OccupancyGrid, max_distance: float, *, downsampled: bool = False) -> None:
        from scipy.ndimage import distance_transform_edt

        if not (np.isfinite(grid.resolution) and grid.resolution > 0.0 and np.isfinite(grid.origin).all()):
            raise LocalizationError(
                f"the map has a resolution of {grid.resolution:g} m and its origin at {grid.origin}; "
                "expected a resolution above 0 and finite numbers"
            )
        occupied = grid.data >= OCCUPIED_FROM
        free = (grid.data >= 0) & (grid.data <= FREE_UP_TO)
        if not occupied.any() or not free.any():
            what = "obstacle" if free.any() else "free cell"
            raise LocalizationError(f"the map has no {what}, so no pose in it can be told from another")
        metres = distance_transform_edt(~occupied) * grid.resolution
        self.distance: Table = np.minimum(metres, max_distance).astype(np.float32)
        self.max_distance = float(max_distance)
        self.resolution = float(grid.resolution)
        self.origin: Array = np.array(grid.origin, dtype=np.float64)
        if downsampled:
            coarse = np.zeros_like(free)
            coarse[::2, ::2] = free[::2, ::2]
            free = coarse if coarse.any() else free
        self._free = np.argwhere(free)
        self._tables: dict[tuple[float, float, float, bool], Table] = {}

    def to_cells(self, poses: Array) -> Array:
        """Return poses (n, 3) of the map's frame with x and y in cells from the origin, along the grid's axes."""
        cells = poses - self.origin if self.origin[2] == 0.0 else between(self.origin, poses)
        cells[:, :2] /= self.resolution
        return cells

    def contains(self, position: Array) -> bool:
        """Return whether a position (x, y) in the map's frame lies on the grid."""
        column, row, _ = self.to_cells(np.array([[position[0], position[1], 0.0]]))[0]
        return bool(0.0 <= column < self.distance.shape[1] and 0.0 <= row < self.distance.shape[0])

    def table(self, z_hit: float, sigma: float, level: float, *, product: bool) -> Table:
        """Return what a beam that ends in a cell adds to the likelihood of a pose.

        The last table is kept, since it is the same for all scans of a scanner.

        Parameters
        ----------
        z_hit, sigma : float
            Weight and standard deviation [m] of hits.
        level : float
            Likelihood of a random reading at any distance.
        product : bool
            Whether the logarithm of the likelihood is wanted rather than its cube.

        Returns
        -------
        ndarray of float32, shape (height + 2, width + 2)
            With a border of one cell for all that is outside of the map.
        """
        key = (z_hit, sigma, level, product)
        if key not in self._tables:
            padded = np.pad(self.distance.astype(np.float64), 1, constant_values=self.max_distance)
            p = z_hit * np.exp(-0.5 * (padded / sigma) ** 2) + level
            with np.errstate(divide="ignore"):
                values = np.maximum(np.log(p), -80.0) if product else p**3
            self._tables = {key: values.astype(np.float32)}
        return self._tables[key]

    def draw_poses(self, count: int, generator: np.random.Generator) -> Array:
        """Draw poses (count, 3) evenly over the free cells and all headings."""
        cells = self._free[generator.integers(self._free.shape[0], size=count)]
        inside = self.resolution * (cells[:, ::-1] + generator.random((count, 2)))
        yaw = generator.uniform(-np.pi, np.pi, count)
        return compose(self.origin, np.concatenate([inside, yaw[:, None]], axis=1))
