"""The contract of a path smoother."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import Costmap

Array = NDArray[np.float64]


class Smoother(ABC):
    """Makes a path smoother without leading it into an obstacle."""

    @abstractmethod
    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Smooth a path.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the costmap's frame.
        costmap : Costmap
            Inflated costs.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses with the same first and last position, each looking along the path.
        """
