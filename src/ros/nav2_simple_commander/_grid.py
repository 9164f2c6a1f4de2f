"""A grid of costs, from a message, by cells and by metres."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time


class Grid:
    """Costs of the cells of a map.

    Parameters
    ----------
    occupancy_map
        A `nav_msgs/OccupancyGrid`, or a `nav2_msgs/Costmap`.
    """

    def __init__(self, occupancy_map: Any) -> None:
        specs = getattr(occupancy_map, "metadata", None)
        specs = occupancy_map.info if specs is None else specs
        self.size_x: int = specs.size_x if hasattr(specs, "size_x") else specs.width
        self.size_y: int = specs.size_y if hasattr(specs, "size_y") else specs.height
        self.resolution: float = specs.resolution
        self.origin_x: float = specs.origin.position.x
        self.origin_y: float = specs.origin.position.y
        self.global_frame_id: str = occupancy_map.header.frame_id
        self.costmap_timestamp: Time = occupancy_map.header.stamp
        self.costmap = np.array(occupancy_map.data).astype(np.uint8)

    def getSizeInCellsX(self) -> int:
        """Return the number of columns."""
        return self.size_x

    def getSizeInCellsY(self) -> int:
        """Return the number of rows."""
        return self.size_y

    def getSizeInMetersX(self) -> float:
        """Return how far apart the left edge and the middle of the last column are [m]."""
        return (self.size_x - 1 + 0.5) * self.resolution

    def getSizeInMetersY(self) -> float:
        """Return how far apart the lower edge and the middle of the last row are [m]."""
        return (self.size_y - 1 + 0.5) * self.resolution

    def getOriginX(self) -> float:
        """Return where the left edge is [m]."""
        return self.origin_x

    def getOriginY(self) -> float:
        """Return where the lower edge is [m]."""
        return self.origin_y

    def getResolution(self) -> float:
        """Return the size of a cell [m]."""
        return self.resolution

    def getGlobalFrameID(self) -> str:
        """Return the frame of the map."""
        return self.global_frame_id

    def getCostmapTimestamp(self) -> Time:
        """Return the time of the map."""
        return self.costmap_timestamp

    def getCostXY(self, mx: int, my: int) -> np.uint8:
        """Return the cost of the cell in a column and a row."""
        return self.getCostIdx(self.getIndex(mx, my))

    def getCostIdx(self, index: int) -> np.uint8:
        """Return the cost of a cell, counted row by row."""
        cost: np.uint8 = self.costmap[index]
        return cost

    def setCost(self, mx: int, my: int, cost: int) -> None:
        """Set the cost of the cell in a column and a row."""
        self.costmap[self.getIndex(mx, my)] = cost

    def mapToWorld(self, mx: int, my: int) -> tuple[float, float]:
        """Return where the middle of a cell is [m]."""
        return (
            self.origin_x + (mx + 0.5) * self.resolution,
            self.origin_y + (my + 0.5) * self.resolution,
        )

    def worldToMap(self, wx: float, wy: float) -> tuple[int, int]:
        """Return the column and the row of a place [m], also where it is outside."""
        return (
            int(np.floor((wx - self.origin_x) / self.resolution)),
            int(np.floor((wy - self.origin_y) / self.resolution)),
        )

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return the column and the row of a place [m]; (None, None) where it is outside."""
        mx, my = self.worldToMap(wx, wy)
        if 0 <= mx < self.size_x and 0 <= my < self.size_y:
            return mx, my
        return None, None

    def getIndex(self, mx: int, my: int) -> int:
        """Return which cell, counted row by row, is in a column and a row."""
        return my * self.size_x + mx
