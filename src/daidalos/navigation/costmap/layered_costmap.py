"""Costmap of several layers, updated only where something changed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Layer
from daidalos.navigation.costmap.costmap import (
    EVERYWHERE,
    FREE_SPACE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Window,
)
from daidalos.navigation.costmap.footprint import Footprint


@dataclass(frozen=True)
class CostmapParameters(Parameters):
    """Parameters of a costmap, by their Nav2 names."""

    width: float = parameter(5.0, "Width of the map.", unit="m", above=0.0, takes_integer=True, read_only=True)
    height: float = parameter(5.0, "Height of the map.", unit="m", above=0.0, takes_integer=True, read_only=True)
    resolution: float = parameter(0.1, "Side of a cell.", unit="m", above=0.0, read_only=True)
    origin_x: float = parameter(0.0, "Lower left corner of the map in its frame.", unit="m", read_only=True)
    origin_y: float = parameter(0.0, "Lower left corner of the map in its frame.", unit="m", read_only=True)
    rolling_window: bool = parameter(False, "Whether the map moves with the robot.", read_only=True)
    track_unknown_space: bool = parameter(
        False, "Whether cells that nothing has seen are unknown instead of free.", read_only=True
    )


class LayeredCostmap:
    """Layers with their combined costmap.

    A rolling window keeps the robot in its middle; otherwise the costmap lies still, or follows the map of a
    layer that has one.

    Parameters
    ----------
    parameters : CostmapParameters
        Size, resolution and place.
    layers : sequence of Layer
        From the lowest to the highest.
    """

    def __init__(self, parameters: CostmapParameters, layers: Sequence[Layer]) -> None:
        self.parameters = parameters
        self.layers = tuple(layers)
        self.default = NO_INFORMATION if parameters.track_unknown_space else FREE_SPACE
        self.costmap = Costmap.filled(
            max(round(parameters.width / parameters.resolution), 1),
            max(round(parameters.height / parameters.resolution), 1),
            parameters.resolution,
            (parameters.origin_x, parameters.origin_y),
            self.default,
        )
        self._pending = EVERYWHERE
        self._used: tuple[Layer, ...] = ()
        for layer in self.layers:
            layer.match_size(self.costmap)

    def update(self, robot_pose: Array, now: float) -> Window:
        """Update the costmap.

        Parameters
        ----------
        robot_pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot in the costmap's frame.
        now : float
            Time [s].

        Returns
        -------
        Window
            The cells that were put together anew.
        """
        moved = self._follow_robot(robot_pose) if self.parameters.rolling_window else self._follow_map()
        used = tuple(layer for layer in self.layers if layer.enabled)
        bounds = EVERYWHERE if moved or used != self._used else self._pending
        self._pending, self._used = Bounds(), used
        for layer in used:
            bounds = layer.update_bounds(robot_pose, now, bounds)
        window = self.costmap.window_of(bounds)
        self.costmap.costs[window.slices] = self.default
        for layer in used:
            layer.update_costs(self.costmap, window)
        return window

    def circumscribed_cost(self, footprint: Footprint) -> int:
        """Return the minimum cost at the robot's centre at which some part may touch an obstacle, at least 1."""
        distance = footprint.circumscribed_radius + self.costmap.resolution
        return max([1, *(layer.cost_at_distance(distance) for layer in self.layers)])

    def clear_entirely(self) -> None:
        """Clear all observations (`ClearEntireCostmap`)."""
        self._clear(self.costmap.window, inside=True)

    def clear_around(self, robot_pose: Array, reset_distance: float) -> None:
        """Clear observations in a square with an edge [m] around the robot (`ClearCostmapAroundRobot`)."""
        self._clear(self._square(robot_pose, reset_distance), inside=True)

    def clear_except(self, robot_pose: Array, reset_distance: float) -> None:
        """Clear observations outside of a square around the robot (`ClearCostmapExceptRegion`)."""
        self._clear(self._square(robot_pose, reset_distance), inside=False)

    def _clear(self, window: Window, *, inside: bool) -> None:
        for layer in self.layers:
            if layer.clearable:
                layer.clear(window, inside=inside)
        self._pending = EVERYWHERE

    def _square(self, robot_pose: Array, edge: float) -> Window:
        x, y = float(robot_pose[0]), float(robot_pose[1])
        return self.costmap.window_of(Bounds(x, y, x, y).expanded(0.5 * edge))

    def _follow_robot(self, robot_pose: Array) -> bool:
        """Move the costmap's centre to the robot; corners of cells stay on multiples of the resolution."""
        costmap = self.costmap
        half = 0.5 * costmap.resolution * np.array([costmap.width, costmap.height])
        origin = np.floor((robot_pose[:2] - half) / costmap.resolution) * costmap.resolution
        costmap.cover(costmap.width, costmap.height, origin, self.default)
        for layer in self.layers:
            layer.match_size(costmap)
        return True

    def _follow_map(self) -> bool:
        """Adopt size and origin of a layer's map; return whether they changed."""
        for layer in self.layers:
            extent = layer.extent
            if extent is None:
                continue
            costmap = self.costmap
            if extent.resolution != costmap.resolution:
                self.costmap = Costmap.filled(
                    extent.width, extent.height, extent.resolution, extent.origin, self.default
                )
            elif extent.costs.shape == costmap.costs.shape and np.array_equal(extent.origin, costmap.origin):
                return False
            else:
                costmap.cover(extent.width, extent.height, extent.origin, self.default)
            for other in self.layers:
                other.match_size(self.costmap)
            return True
        return False
