"""Conversion between costs (0..255) and values of `nav_msgs/OccupancyGrid` (-1..100)."""

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.costmap.costmap import (
    FREE_SPACE,
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    MAX_NON_OBSTACLE,
    NO_INFORMATION,
    Costs,
)

Occupancy = NDArray[np.int8]


def to_occupancy(costs: Costs) -> Occupancy:
    """Return the occupancy values of costs, as Nav2 publishes costmaps.

    Free is 0, an obstacle 100, the inscribed radius 99, unknown -1; what lies between is spread over 1..98.
    """
    return _OCCUPANCY_OF_COST[costs]


def from_occupancy(
    occupancy: Occupancy,
    *,
    lethal_cost_threshold: int = 100,
    unknown_cost_value: int = -1,
    trinary_costmap: bool = True,
    track_unknown_space: bool = True,
) -> Costs:
    """Return the costs of occupancy values.

    Parameters
    ----------
    occupancy : ndarray of int8
        Values of a `nav_msgs/OccupancyGrid`, any shape.
    lethal_cost_threshold : int
        Smallest value that is an obstacle.
    unknown_cost_value : int
        The value that means unknown.
    trinary_costmap : bool
        Whether everything between unknown and lethal is free; otherwise it is scaled to 0..254.
    track_unknown_space : bool
        Whether unknown stays unknown; otherwise it is free.
    """
    values = np.arange(256, dtype=np.int16)
    values[128:] -= 256
    scaled = np.clip(values, 0, lethal_cost_threshold) / max(lethal_cost_threshold, 1) * LETHAL_OBSTACLE
    table = np.full(256, FREE_SPACE, dtype=np.uint8) if trinary_costmap else scaled.astype(np.uint8)
    table[values >= lethal_cost_threshold] = LETHAL_OBSTACLE
    table[values == unknown_cost_value] = NO_INFORMATION if track_unknown_space else FREE_SPACE
    costs: Costs = table[np.ascontiguousarray(occupancy, dtype=np.int8).view(np.uint8)]
    return costs


def _occupancy_of_cost() -> Occupancy:
    table = np.zeros(256, dtype=np.int8)
    between = np.arange(1, MAX_NON_OBSTACLE + 1)
    table[between] = 1 + (97 * (between - 1)) // (MAX_NON_OBSTACLE - 1)
    table[INSCRIBED_INFLATED_OBSTACLE] = 99
    table[LETHAL_OBSTACLE] = 100
    table[NO_INFORMATION] = -1
    return table


_OCCUPANCY_OF_COST = _occupancy_of_cost()
