"""Makes the maps of the worlds that come with the package: `python tools/make_maps.py`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from scipy.ndimage import label

from daidalos.description import sdf
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import save_map
from daidalos.simulation import Simulation

SHARE = Path(__file__).parent.parent / "src/daidalos/share"
RESOLUTION = 0.05
HEIGHT = 0.15
"""Height [m] above which something is an obstacle, that of a TurtleBot3's lidar."""


def main() -> None:
    """Write every map."""
    hexagon = SHARE / "turtlebot3_gazebo/worlds/hexagon.world"
    maps = SHARE / "nav2_bringup/maps"
    maps.mkdir(exist_ok=True)
    save_map(map_of(hexagon, 7.0, (-2.0, -0.5)), maps / "turtlebot3_world")


def map_of(world: Path, side: float, inside: tuple[float, float]) -> OccupancyGrid:
    """Return the map of a world as seen from above; what cannot be reached is unknown.

    Parameters
    ----------
    world : Path
    side : float
        Of the map, whose middle is the origin [m].
    inside : tuple of 2 floats
        Position that can be reached [m].
    """
    physics = Simulation(sdf.load(str(world))).physics
    mujoco.mj_forward(physics.model, physics.data)
    count = round(side / RESOLUTION)
    low = -0.5 * count * RESOLUTION
    centers = low + (np.arange(count) + 0.5) * RESOLUTION
    occupied = np.array([[_height(physics, x, y) > HEIGHT for x in centers] for y in centers])
    regions, _ = label(~occupied)
    column, row = (int((at - low) / RESOLUTION) for at in inside)
    free = regions == regions[row, column]
    around = np.pad(free, 1)
    beside = np.any(
        [around[1 + i : count + 1 + i, 1 + j : count + 1 + j] for i in (-1, 0, 1) for j in (-1, 0, 1)], axis=0
    )
    data = np.full((count, count), -1, dtype=np.int8)
    data[free] = 0
    data[occupied & beside] = 100
    return OccupancyGrid(data, RESOLUTION, (low, low, 0.0))


def _height(physics: Any, x: float, y: float) -> float:
    """Return the height [m] of what lies under a position."""
    start = np.array([x, y, 10.0])
    hit = np.zeros(1, dtype=np.int32)
    length = mujoco.mj_ray(physics.model, physics.data, start, np.array([0.0, 0.0, -1.0]), None, 1, -1, hit)
    return 10.0 - float(length) if length >= 0.0 else 0.0


if __name__ == "__main__":
    main()
