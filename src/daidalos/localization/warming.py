"""Compilation of every kernel of localization ahead of its first use."""

from collections.abc import Iterator

import numpy as np

from daidalos.localization.amcl import SENSOR_MODELS, Amcl
from daidalos.localization.config import AmclConfig
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData


def steps() -> Iterator[tuple[float, str]]:
    """Update a filter of each sensor model with a scan of a small room; see `daidalos.common.kernels.warm_up`."""
    data = np.zeros((40, 40), dtype=np.int8)
    data[0], data[-1], data[:, 0], data[:, -1] = 100, 100, 100, 100
    room = OccupancyGrid(data, 0.05, (-1.0, -1.0, 0.0))
    scan = LaserScanData(np.ones(8), -np.pi, np.pi / 4.0, 0.1, 10.0)
    for done, model in enumerate(SENSOR_MODELS):
        yield done / len(SENSOR_MODELS), model
        config = AmclConfig(laser_model_type=model, min_particles=10, max_particles=20)
        Amcl(config, room).update(np.zeros(3), scan)
