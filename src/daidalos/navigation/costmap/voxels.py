"""Grid of voxels above the cells of a costmap."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array

Bits = NDArray[np.uint16]
"""A bit for each voxel above a cell, the lowest voxel's first; shape (height, width)."""


@dataclass(frozen=True)
class VoxelGrid:
    """Voxels above the cells of a costmap.

    Attributes
    ----------
    marked, unknown : ndarray of uint16, shape (height, width)
        Whether each voxel is occupied, and whether nothing was seen of it.
    origin : ndarray, shape (3,)
        Lower corner [m] of the grid in the costmap's frame.
    resolution, height : float
        Side and height [m] of a voxel.
    levels : int
        Number of voxels above a cell.
    """

    marked: Bits
    unknown: Bits
    origin: Array
    resolution: float
    height: float
    levels: int
