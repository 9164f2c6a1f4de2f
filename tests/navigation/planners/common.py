"""Checks and cases of all planners."""

import math
from itertools import pairwise

import numpy as np
import pytest

from daidalos.navigation.costmap.costmap import NO_INFORMATION, Costmap
from daidalos.navigation.errors import GoalOccupied, GoalOutsideMap, NoPath, StartOccupied, StartOutsideMap


def pose(x, y, yaw=0.0):
    return np.array([x, y, yaw])


def room(size=4.0, resolution=0.05):
    cells = round(size / resolution)
    return Costmap.filled(cells, cells, resolution, (0.0, 0.0))


def densely(path, count=8):
    """Return points (n, 2) of a path with others between them."""
    points = path[:, :2]
    return np.concatenate(
        [a + (b - a) * np.linspace(0.0, 1.0, count)[:, None] for a, b in pairwise(points)] or [points]
    )


def is_free(costmap, path):
    """Return whether a round robot's centre is nowhere within its radius of an obstacle."""
    return all(costmap.cost_at(*point) < 253 or costmap.cost_at(*point) == NO_INFORMATION for point in densely(path))


def refuses_bad_poses(make):
    """Check each error of a planner, which `make` makes without tolerance."""
    planner = make()
    cases = [
        (pose(-1.0, 1.0), pose(1.0, 1.0), StartOutsideMap, "is outside of the map"),
        (pose(1.0, 1.0), pose(9.0, 1.0), GoalOutsideMap, "is outside of the map"),
        (pose(1.0, 1.0), pose(math.nan, 1.0), GoalOutsideMap, "nan"),
        (pose(1.0, 1.0), pose(2.02, 2.02), GoalOccupied, "the goal"),
        (pose(2.02, 2.02), pose(1.0, 1.0), StartOccupied, "enclosed"),
        (pose(1.0, 1.0), pose(3.8, 1.0), NoPath, "the goal"),
    ]
    for start, goal, error, words in cases:
        costmap = room()
        costmap.costs[25:56, 25:56] = 254
        costmap.costs[:, 70] = 254
        with pytest.raises(error, match=words) as caught:
            planner.create_plan(costmap, start, goal)
        assert "\n" not in str(caught.value)
