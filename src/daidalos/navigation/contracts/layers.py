"""Contract of costmap layers."""

from __future__ import annotations

from abc import abstractmethod

from daidalos.common.arrays import Array
from daidalos.navigation.contracts.extension import NavigationExtension
from daidalos.navigation.contracts.topics import Input, Output
from daidalos.navigation.costmap.costmap import FREE_SPACE, Bounds, Costmap, Window
from daidalos.navigation.costmap.voxels import VoxelGrid


class Layer(NavigationExtension):
    """Source of costs; layers are combined in the order of the costmap's list.

    Attributes
    ----------
    clearable : bool
        Whether the clearing services of a costmap make this layer forget.
    """

    clearable: bool = False

    @property
    def enabled(self) -> bool:
        """Whether the layer is used: its parameter `enabled`, where it has one."""
        return bool(getattr(self.parameters, "enabled", True))

    @property
    def contained(self) -> tuple[Layer, ...]:
        """Layers that this one is made of."""
        return ()

    @property
    def voxels(self) -> VoxelGrid | None:
        """What the layer knows in space, for display; None for layers that are flat."""
        return None

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the layer subscribes to."""
        return ()

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Topics that the layer publishes on while it is enabled."""
        return ()

    def missing_input(self, now: float) -> str:
        """Return what the layer lacks at a time [s] to know the present, in words; empty where it lacks nothing."""
        return ""

    def age_of_input(self, now: float) -> float:
        """Return how old the layer's oldest input is at a time [s], as a share of what is allowed; 0 without inputs."""
        return 0.0

    @property
    def extent(self) -> Costmap | None:
        """Costmap whose size and origin the whole costmap takes over; `None` for layers without a size."""
        return None

    def match_size(self, costmap: Costmap) -> None:
        """Adapt to the changed size and origin of the costmap."""

    @abstractmethod
    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Return the bounds of the area that must be updated.

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
        """Write this layer's costs into a window of the costmap, on top of the layers below."""

    def cost_at_distance(self, distance: float) -> int:
        """Return the cost that this layer gives a cell at a distance [m] from an obstacle."""
        return FREE_SPACE

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Clear the inside of a window of cells, or its outside."""
