"""Costs of a costmap at the places of a graph, whatever frame the costmap has."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose2 import transform_points
from daidalos.navigation.costmap.costmap import INSCRIBED_INFLATED_OBSTACLE, NO_INFORMATION, Costmap

_STILL = (0.0, 0.0, 0.0)


class RouteCosts:
    """View of a costmap for points of a graph.

    Parameters
    ----------
    costmap : Costmap
    pose : array_like, shape (3,)
        Pose (x, y, yaw) of the graph's frame in that of the costmap.
    """

    def __init__(self, costmap: Costmap, pose: ArrayLike = _STILL) -> None:
        self.costmap = costmap
        self._pose = pose

    def cell(self, point: Array) -> tuple[int, int]:
        """Return column and row of a point (x, y) [m]; they may be outside."""
        x, y = transform_points(self._pose, np.asarray(point, float)[None, :2])[0]
        return self.costmap.world_to_map(x, y)

    def along(self, start: Array, end: Array, stride: int = 1) -> NDArray[np.uint8] | None:
        """Return the costs of the cells on a line; None where one of its ends is outside the costmap.

        Parameters
        ----------
        start, end : ndarray, shape (2,)
            Points [m].
        stride : int
            1 for every cell, 2 for every other, and so on; the last one is always there.
        """
        first, last = self.cell(start), self.cell(end)
        if not (self.costmap.holds(*first) and self.costmap.holds(*last)):
            return None
        steps = max(abs(last[0] - first[0]), abs(last[1] - first[1]))
        shares = np.append(np.arange(0, steps, stride), steps) / max(steps, 1)
        columns = np.rint(first[0] + shares * (last[0] - first[0])).astype(np.intp)
        rows = np.rint(first[1] + shares * (last[1] - first[1])).astype(np.intp)
        costs: NDArray[np.uint8] = self.costmap.costs[rows, columns]
        return costs

    def inside(self, start: Array, end: Array) -> Array | None:
        """Return the end of the part of a line that is on the costmap, None where its start is not."""
        if not self.costmap.holds(*self.cell(start)):
            return None
        low, high = 0.0, 1.0
        if self.costmap.holds(*self.cell(end)):
            return end
        for _ in range(20):  # to a millionth of the line
            middle = 0.5 * (low + high)
            is_inside = self.costmap.holds(*self.cell(start + middle * (end - start)))
            low, high = (middle, high) if is_inside else (low, middle)
        cut: Array = start + low * (end - start)
        return cut


def is_blocked(costs: NDArray[np.uint8], max_cost: float = INSCRIBED_INFLATED_OBSTACLE) -> bool:
    """Return whether a cost is at least the largest allowed one; unknown cells are not."""
    return bool(np.any((costs >= max_cost) & (costs != NO_INFORMATION)))
