"""Static layer: the costs of a map from a map server or from SLAM."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import EVERYWHERE, Bounds, Costmap, CostmapError, Window
from daidalos.navigation.costmap.occupancy import from_occupancy


@dataclass(frozen=True)
class StaticLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    map_topic: str = parameter("", "Topic of the map; empty for the costmap's map_topic.", read_only=True)
    lethal_cost_threshold: int = parameter(
        100, "Value of the map from which a cell is an obstacle.", minimum=0, maximum=100, read_only=True
    )
    unknown_cost_value: int = parameter(
        -1, "Value of the map that means unknown.", minimum=-1, maximum=255, read_only=True
    )
    trinary_costmap: bool = parameter(
        True, "Whether cells are free, occupied or unknown, and nothing in between.", read_only=True
    )
    track_unknown_space: bool = parameter(True, "Whether unknown cells stay unknown instead of free.", read_only=True)
    map_subscribe_transient_local: bool = parameter(
        True, "Whether a map that was published before is taken from a latched topic.", read_only=True
    )
    enabled: bool = parameter(True, "Whether the layer is used.")


class StaticLayer(Layer):
    """Layer of a map's obstacles, whose size and origin the costmap takes over."""

    names = ("nav2_costmap_2d::StaticLayer",)
    Parameters = StaticLayerParameters
    parameters: StaticLayerParameters

    def __init__(
        self, parameters: StaticLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._map: Costmap | None = None
        self._changed = Bounds()

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        p = self.parameters
        return (Input(p.map_topic, OccupancyGrid, self.set_map, latched=p.map_subscribe_transient_local),)

    def missing_input(self, now: float) -> str:
        """Return that there is no map until one has come."""
        return "" if self._map is not None else "there is no map"

    def set_map(self, grid: OccupancyGrid) -> None:
        """Set the map; only differences to the last one are updated.

        Raises
        ------
        CostmapError
            The map has no cells or is turned.
        """
        x, y, yaw = grid.origin
        if grid.data.size == 0:
            raise CostmapError("the map has no cells")
        if yaw != 0.0:
            raise CostmapError(f"the map is turned by {yaw} rad, but a costmap follows the axes of its frame")
        costs = from_occupancy(
            grid.data,
            lethal_cost_threshold=self.parameters.lethal_cost_threshold,
            unknown_cost_value=self.parameters.unknown_cost_value,
            trinary_costmap=self.parameters.trinary_costmap,
            track_unknown_space=self.parameters.track_unknown_space,
        )
        latest = Costmap(costs, grid.resolution, (x, y))
        self._changed = self._changed.including(_difference(self._map, latest))
        self._map = latest

    @property
    def extent(self) -> Costmap | None:
        """Current map."""
        return self._map

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Return the bounds of the changes between the last two maps."""
        changed, self._changed = self._changed, Bounds()
        return bounds.including(changed)

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Copy the map below all other layers."""
        if self._map is None:
            return
        offset = (costmap.origin - self._map.origin) / costmap.resolution
        right, up = round(float(offset[0])), round(float(offset[1]))
        left, stop_column = max(window.left, -right), min(window.right, self._map.width - right)
        bottom, stop_row = max(window.bottom, -up), min(window.top, self._map.height - up)
        if left < stop_column and bottom < stop_row:
            costmap.costs[bottom:stop_row, left:stop_column] = self._map.costs[
                bottom + up : stop_row + up, left + right : stop_column + right
            ]


def _difference(before: Costmap | None, after: Costmap) -> Bounds:
    """Return the rectangle around all cells whose cost differs."""
    if (
        before is None
        or before.costs.shape != after.costs.shape
        or before.resolution != after.resolution
        or not np.array_equal(before.origin, after.origin)
    ):
        return EVERYWHERE
    differs = before.costs != after.costs
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if rows.size == 0:
        return Bounds()
    min_x, min_y = after.map_to_world(int(columns[0]), int(rows[0]))
    max_x, max_y = after.map_to_world(int(columns[-1]), int(rows[-1]))
    return Bounds(min_x, min_y, max_x, max_y)
