"""Static layer: the costs of a map from a map server or from SLAM."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import inverse, transform_points
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
    transform_tolerance: float = parameter(
        0.3,
        "Age of the transform from the map's frame to that of the costmap from which the costmap is out of date.",
        unit="s",
        above=0.0,
    )
    enabled: bool = parameter(True, "Whether the layer is used.")


class StaticLayer(Layer):
    """Layer of a map's obstacles, whose size and origin the costmap takes over where both have the same frame.

    A map in another frame, such as in a costmap around the robot in the frame of the odometry, is placed by the latest
    transform.
    """

    names = ("nav2_costmap_2d::StaticLayer",)
    Parameters = StaticLayerParameters
    parameters: StaticLayerParameters

    def __init__(
        self, parameters: StaticLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._map: Costmap | None = None
        self._frame = ""
        self._place = np.zeros(3)
        self._changed = Bounds()

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs`."""
        p = self.parameters
        return (Input(p.map_topic, OccupancyGrid, self.set_map, latched=p.map_subscribe_transient_local),)

    def missing_input(self, now: float) -> str:
        """Return that there is no map until one has come, or that its place is not known."""
        if self._map is None:
            return "there is no map"
        if not self._is_elsewhere:
            return ""
        found = self.context.locate(self._frame)
        frames = f"from the map's frame '{self._frame}' to {self.context.global_frame}"
        if found is None:
            return f"there is no transform {frames}"
        tolerance = self.parameters.transform_tolerance
        if found[1] > tolerance:
            return f"the transform {frames} is {found[1]:.3g} s old, longer than transform_tolerance {tolerance:g} s"
        return ""

    def age_of_input(self, now: float) -> float:
        """Implement `Layer.age_of_input` by the transform's age."""
        found = self.context.locate(self._frame) if self._is_elsewhere else None
        return 0.0 if found is None else found[1] / self.parameters.transform_tolerance

    @property
    def _is_elsewhere(self) -> bool:
        """Whether the map's frame is another one than the costmap's."""
        return self._frame not in ("", self.context.global_frame)

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
        self._map, self._frame = latest, grid.frame

    @property
    def extent(self) -> Costmap | None:
        """Current map; None where the costmap cannot take over its size."""
        return None if self._is_elsewhere else self._map

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Return the bounds of the changes between the last two maps."""
        changed, self._changed = self._changed, Bounds()
        if self._is_elsewhere:
            found = self.context.locate(self._frame)
            if found is not None:
                self._place = found[0]
            return EVERYWHERE
        return bounds.including(changed)

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Copy the map below all other layers."""
        if self._map is None:
            return
        if self._is_elsewhere:
            self._copy_turned(self._map, costmap, window)
            return
        offset = (costmap.origin - self._map.origin) / costmap.resolution
        right, up = round(float(offset[0])), round(float(offset[1]))
        left, stop_column = max(window.left, -right), min(window.right, self._map.width - right)
        bottom, stop_row = max(window.bottom, -up), min(window.top, self._map.height - up)
        if left < stop_column and bottom < stop_row:
            costmap.costs[bottom:stop_row, left:stop_column] = self._map.costs[
                bottom + up : stop_row + up, left + right : stop_column + right
            ]

    def _copy_turned(self, source: Costmap, costmap: Costmap, window: Window) -> None:
        """Copy the cells of a map in another frame that lie below the middles of those of the window."""
        rows, columns = np.mgrid[window.slices]
        points = costmap.origin + (np.stack([columns, rows], axis=-1).reshape(-1, 2) + 0.5) * costmap.resolution
        there = transform_points(inverse(self._place), points)
        column, row = np.floor((there - source.origin) / source.resolution).astype(np.int64).T
        inside = (column >= 0) & (row >= 0) & (column < source.width) & (row < source.height)
        costs = costmap.costs[window.slices].reshape(-1)
        costs[inside] = source.costs[row[inside], column[inside]]
        costmap.costs[window.slices] = costs.reshape(rows.shape)


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
