"""Distances to the occupied cells of a grid along rays."""

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array


def cast_rays(
    occupied: NDArray[np.bool_], resolution: float, origin: Array, pose: Array, angles: Array, max_range: float
) -> Array:
    """Return the distance [m] to the first occupied cell on each ray, infinite where there is none.

    Parameters
    ----------
    occupied : ndarray of bool, shape (rows, columns)
        Row 0 is at the origin.
    resolution : float
        Side of a cell [m].
    origin : ndarray, shape (2,)
        Position [m] of the outer corner of cell (0, 0).
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) from which the rays are cast, in the grid's frame.
    angles : ndarray, shape (n,)
        Directions of the rays in the pose's frame [rad].
    max_range : float
        Length of the rays [m].
    """
    distances = np.arange(0.0, max_range, 0.5 * resolution)
    directions = np.asarray(angles) + pose[2]
    columns = np.floor((pose[0] - origin[0] + np.outer(np.cos(directions), distances)) / resolution).astype(np.intp)
    rows = np.floor((pose[1] - origin[1] + np.outer(np.sin(directions), distances)) / resolution).astype(np.intp)
    is_inside = (rows >= 0) & (columns >= 0) & (rows < occupied.shape[0]) & (columns < occupied.shape[1])
    hits = np.zeros(rows.shape, bool)
    hits[is_inside] = occupied[rows[is_inside], columns[is_inside]]
    found: Array = np.where(hits.any(axis=1), distances[hits.argmax(axis=1)], np.inf)
    return found
