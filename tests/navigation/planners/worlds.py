"""Random rooms for planners."""

import numpy as np

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters


def cluttered(seed, height=60, width=70, boxes=10, inflated=True):
    """A walled room with boxes, and a generator that goes on from its seed."""
    generator = np.random.default_rng(seed)
    costs = np.zeros((height, width), dtype=np.uint8)
    costs[0] = costs[-1] = 254
    costs[:, 0] = costs[:, -1] = 254
    for _ in range(boxes):
        row, column = generator.integers(1, (height - 12, width - 12))
        tall, wide = generator.integers(2, 12, 2)
        costs[row : row + tall, column : column + wide] = 254
    costmap = Costmap(costs, 0.05, (-1.0, 2.0))
    if inflated:
        layer = InflationLayer(InflationLayerParameters(0.4, 5.0), NavigationContext(footprint=Footprint.circle(0.1)))
        layer.update_costs(costmap, costmap.window)
    return costmap, generator


def random_pose(costmap, generator, below=253):
    """A pose at the centre of a cell that costs less than a limit."""
    cells = np.argwhere(costmap.costs < below)
    row, column = cells[generator.integers(cells.shape[0])]
    x, y = costmap.map_to_world(int(column), int(row))
    return np.array([x, y, generator.uniform(-3.0, 3.0)])
