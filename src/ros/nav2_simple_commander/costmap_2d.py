"""Costmaps."""

from nav2_simple_commander._grid import Grid


class PyCostmap2D(Grid):
    """Costs from 0 (free) over 253 (the robot's middle must not be here) and 254 (lethal) to 255 (unknown)."""
