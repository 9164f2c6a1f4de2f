"""Inflation of obstacles with costs that fall with the distance."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Layer, NavigationContext
from daidalos.navigation.costmap.costmap import (
    EVERYWHERE,
    FREE_SPACE,
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    MAX_NON_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Costs,
    Window,
)


@dataclass(frozen=True)
class InflationLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    inflation_radius: float = parameter(0.55, "Distance from obstacles that costs reach.", unit="m", minimum=0.0)
    cost_scaling_factor: float = parameter(
        10.0, "How fast costs fall with the distance from obstacles.", unit="1/m", minimum=0.0
    )
    inflate_unknown: bool = parameter(False, "Whether unknown cells get costs.")
    inflate_around_unknown: bool = parameter(False, "Whether unknown cells count as obstacles.")
    enabled: bool = parameter(True, "Whether the layer is used.")


class InflationLayer(Layer):
    """Layer that inflates obstacles by the robot's inscribed radius, and beyond it with falling costs.

    A cell at distance d of an obstacle costs 253 up to the inscribed radius r, then `252 exp(-k (d - r))`
    with k the cost scaling factor, up to the inflation radius. Distances are exact between the centres of
    cells.
    """

    names = ("nav2_costmap_2d::InflationLayer",)
    Parameters = InflationLayerParameters
    parameters: InflationLayerParameters

    def __init__(
        self, parameters: InflationLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self.inscribed_radius = self.context.footprint.inscribed_radius
        self._table: tuple[float, Costs] | None = None
        self._is_outdated = False

    def reconfigure(self, parameters: InflationLayerParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; the next update inflates the whole costmap."""
        super().reconfigure(parameters)
        self._table, self._is_outdated = None, True

    def cost_at_distance(self, distance: float) -> int:
        """Implement `Layer.cost_at_distance`."""
        if distance > self.parameters.inflation_radius:
            return FREE_SPACE
        if distance <= self.inscribed_radius:
            return INSCRIBED_INFLATED_OBSTACLE
        slope = math.exp(-self.parameters.cost_scaling_factor * (distance - self.inscribed_radius))
        return int(MAX_NON_OBSTACLE * slope)

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Expand the bounds by the inflation radius."""
        if self._is_outdated:
            self._is_outdated = False
            return EVERYWHERE
        return bounds.expanded(self.parameters.inflation_radius)

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Raise the costs around obstacles; higher costs stay."""
        if window.empty or self.parameters.inflation_radius <= 0.0:
            return
        if self._table is None or self._table[0] != costmap.resolution:
            self._table = (
                costmap.resolution,
                cost_of_squared_distance(self.parameters, self.inscribed_radius, costmap.resolution),
            )
        table = self._table[1]
        inflate(
            costmap.costs,
            window.left,
            window.bottom,
            window.right,
            window.top,
            table,
            self.parameters.inflate_unknown,
            self.parameters.inflate_around_unknown,
        )


def cost_of_squared_distance(parameters: InflationLayerParameters, inscribed_radius: float, resolution: float) -> Costs:
    """Return the cost at every squared distance in cells, from 0 to the square of the inflation radius."""
    reach = math.floor(parameters.inflation_radius / resolution + 1e-9)
    distance = np.sqrt(np.arange(reach * reach + 1)) * resolution
    slope = np.exp(-parameters.cost_scaling_factor * (distance - inscribed_radius))
    costs: Costs = np.where(
        distance <= inscribed_radius + 1e-9, INSCRIBED_INFLATED_OBSTACLE, MAX_NON_OBSTACLE * slope
    ).astype(np.uint8)
    costs[0] = LETHAL_OBSTACLE
    return costs


@compiled
def inflate(
    costs: Costs,
    left: int,
    bottom: int,
    right: int,
    top: int,
    table: Costs,
    inflate_unknown: bool,
    around_unknown: bool,
) -> None:
    """Inflate a window of cells in place, including obstacles outside of it up to the table's range.

    Two passes of the exact squared distance transform, cut off at the reach: down and up every column, then
    for each cell the best over the columns in reach of its row.
    """
    reach = int(math.sqrt(table.shape[0] - 1) + 0.5)
    far = table.shape[0]
    first = max(left - reach, 0)
    last = min(right + reach, costs.shape[1])
    lowest = max(bottom - reach, 0)
    highest = min(top + reach, costs.shape[0])
    vertical = _vertical_distances(costs, first, last, lowest, highest, bottom, top, reach, around_unknown)
    squared = np.empty(right - left, dtype=np.int32)
    for row in range(bottom, top):
        line = vertical[row - bottom]
        if not _squared_distances(line, left - first, reach, far, squared):
            continue
        for column in range(left, right):
            d = squared[column - left]
            if d >= far:
                continue
            cost = table[d]
            old = costs[row, column]
            if old == NO_INFORMATION:
                if cost > FREE_SPACE if inflate_unknown else cost >= INSCRIBED_INFLATED_OBSTACLE:
                    costs[row, column] = cost
            elif cost > old:
                costs[row, column] = cost


@compiled
def _vertical_distances(
    costs: Costs,
    first: int,
    last: int,
    lowest: int,
    highest: int,
    bottom: int,
    top: int,
    reach: int,
    around_unknown: bool,
) -> NDArray[np.int32]:
    """Return the distance in cells to the nearest obstacle in the same column, reach + 1 if there is none."""
    far = reach + 1
    distances = np.empty((top - bottom, last - first), dtype=np.int32)
    running = np.full(last - first, far, dtype=np.int32)
    for row in range(lowest, top):
        for column in range(first, last):
            cost = costs[row, column]
            if cost == LETHAL_OBSTACLE or (around_unknown and cost == NO_INFORMATION):
                running[column - first] = 0
            elif running[column - first] < far:
                running[column - first] += 1
            if row >= bottom:
                distances[row - bottom, column - first] = running[column - first]
    running[:] = far
    for row in range(highest - 1, bottom - 1, -1):
        for column in range(first, last):
            cost = costs[row, column]
            if cost == LETHAL_OBSTACLE or (around_unknown and cost == NO_INFORMATION):
                running[column - first] = 0
            elif running[column - first] < far:
                running[column - first] += 1
            if row < top and running[column - first] < distances[row - bottom, column - first]:
                distances[row - bottom, column - first] = running[column - first]
    return distances


@compiled
def _squared_distances(line: NDArray[np.int32], start: int, reach: int, far: int, squared: NDArray[np.int32]) -> bool:
    """Compute the squared distances to the nearest obstacle along one row; return False without obstacles in range."""
    squared[:] = far
    found = False
    for column in range(line.shape[0]):
        height = line[column]
        if height > reach:
            continue
        found = True
        low = max(column - reach, start)
        high = min(column + reach + 1, start + squared.shape[0])
        for other in range(low, high):
            d = (other - column) * (other - column) + height * height
            if d < squared[other - start]:
                squared[other - start] = d
    return found
