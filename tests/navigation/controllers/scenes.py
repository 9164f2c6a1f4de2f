"""What controllers are shown in tests."""

import numpy as np

from daidalos.navigation.contracts import ControlInput, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from daidalos.navigation.paths import path_length, with_headings


def ground(obstacles=(), size=6.0, radius=0.2):
    """Inflated ground around the origin with lethal points."""
    cells = round(size / 0.05)
    costmap = Costmap.filled(cells, cells, 0.05, (-0.5 * size, -0.5 * size))
    for x, y in obstacles:
        column, row = costmap.world_to_map(x, y)
        costmap.costs[row, column] = 254
    InflationLayer(
        InflationLayerParameters(0.55, 4.0), NavigationContext(footprint=Footprint.circle(radius))
    ).update_costs(costmap, costmap.window)
    return costmap


def line(end, start=(0.0, 0.0), heading=None):
    """Straight path with a pose every 5 cm."""
    start, end = np.array(start, dtype=float), np.array(end, dtype=float)
    count = max(int(np.hypot(*(end - start)) / 0.05), 1) + 1
    return with_headings(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start), final_heading=heading)


def control(path, costmap=None, pose=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), distance=None, **more):
    """Input of a controller."""
    length = path_length(path) if distance is None else distance
    return ControlInput(
        np.array(pose, dtype=float),
        np.array(velocity, dtype=float),
        path,
        path[-1],
        length,
        ground() if costmap is None else costmap,
        **more,
    )
