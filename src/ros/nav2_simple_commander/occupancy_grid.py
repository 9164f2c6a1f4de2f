"""Occupancy grids."""

from nav2_simple_commander._grid import Grid


class PyOccupancyGrid(Grid):
    """Shares of occupancy from 0 (free) to 100 (occupied); 255 is unknown."""
