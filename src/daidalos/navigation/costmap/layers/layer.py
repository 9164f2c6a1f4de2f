"""The contract of a costmap layer: say what changed, then write it."""

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import Bounds, Costmap, Window

Array = NDArray[np.float64]


class Layer(ABC):
    """One source of costs; layers are put on top of each other in the order of the costmap's list.

    Attributes
    ----------
    clearable : bool
        Whether the clearing services of a costmap make this layer forget.
    """

    clearable: bool = False

    @property
    def extent(self) -> Costmap | None:
        """A costmap whose size and place the whole must take over; `None` where this layer does not mind."""
        return None

    def match_size(self, costmap: Costmap) -> None:  # noqa: B027 (most layers keep no grid of their own)
        """Take over size and place of the costmap, which changed."""

    @abstractmethod
    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Say which part of the world must be put together anew.

        Parameters
        ----------
        robot_pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot in the costmap's frame.
        now : float
            Time [s].
        bounds : Bounds
            What the layers below asked for.

        Returns
        -------
        Bounds
            The same or more.
        """

    @abstractmethod
    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Write this layer's costs into a window of the costmap, on top of what the layers below wrote."""

    def clear(self, keep: Window, *, inside: bool) -> None:  # noqa: B027 (most layers have nothing to forget)
        """Forget what is inside of a window of cells, or what is outside of it."""
