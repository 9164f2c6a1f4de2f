"""Collision check of a robot's footprint on a costmap."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from geometry_msgs.msg import Point32, Polygon

from nav2_simple_commander.line_iterator import LineIterator

if TYPE_CHECKING:
    from nav2_simple_commander.costmap_2d import PyCostmap2D

NO_INFORMATION = 255
LETHAL_OBSTACLE = 254
INSCRIBED_INFLATED_OBSTACLE = 253
MAX_NON_OBSTACLE = 252
FREE_SPACE = 0


class FootprintCollisionChecker:
    """Checker that finds the highest cost on a robot's outline."""

    def __init__(self) -> None:
        self.costmap_: PyCostmap2D | None = None

    def setCostmap(self, costmap: PyCostmap2D) -> None:
        """Set the costmap that footprints are checked on."""
        self.costmap_ = costmap

    def footprintCost(self, footprint: Polygon) -> float:
        """Return the highest cost on an outline [m in the costmap's frame]; lethal where a corner is outside.

        Raises
        ------
        ValueError
            If there is no costmap.
        """
        corners = [self.worldToMapValidated(point.x, point.y) for point in footprint.points]
        cost = 0.0
        for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
            if x0 is None or y0 is None or x1 is None or y1 is None:
                return float(LETHAL_OBSTACLE)
            cost = max(cost, self.lineCost(x0, x1, y0, y1))
        return cost

    def footprintCostAtPose(self, x: float, y: float, theta: float, footprint: Polygon) -> float:
        """Return the highest cost on the outline of a robot at a pose [m, rad]; see `footprintCost`."""
        cosine, sine = math.cos(theta), math.sin(theta)
        moved = [
            Point32(x=x + cosine * point.x - sine * point.y, y=y + sine * point.x + cosine * point.y)
            for point in footprint.points
        ]
        return self.footprintCost(Polygon(points=moved))

    def lineCost(self, x0: int, x1: int, y0: int, y1: int, step_size: float = 0.5) -> float:
        """Return the highest cost on the line between two cells, looked at in steps [cells]."""
        if (x0, y0) == (x1, y1):
            return self.pointCost(x0, y0)
        # The iterator steps along x, and so would pass over rows of a steep line.
        steep = abs(y1 - y0) > abs(x1 - x0)
        line = LineIterator(y0, x0, y1, x1, step_size) if steep else LineIterator(x0, y0, x1, y1, step_size)
        cost = 0.0
        while line.isValid() and cost < LETHAL_OBSTACLE:
            along, across = round(line.getX()), round(line.getY())
            cost = max(cost, self.pointCost(across, along) if steep else self.pointCost(along, across))
            line.advance()
        return cost

    def pointCost(self, x: int, y: int) -> float:
        """Return the cost of a cell.

        Raises
        ------
        ValueError
            If there is no costmap.
        """
        return float(self._costmap().getCostXY(x, y))

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return the column and the row of a place [m]; (None, None) where it is outside.

        Raises
        ------
        ValueError
            If there is no costmap.
        """
        return self._costmap().worldToMapValidated(wx, wy)

    def _costmap(self) -> PyCostmap2D:
        if self.costmap_ is None:
            raise ValueError("Costmap not specified, use setCostmap to specify the costmap first")
        return self.costmap_
