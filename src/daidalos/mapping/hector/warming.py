"""Compilation of every kernel of mapping without odometry ahead of its first use."""

from collections.abc import Iterator

import numpy as np

from daidalos.mapping.hector.slam import HectorConfig, HectorSlam, beam_ends
from daidalos.mapping.scan import LaserScanData


def steps() -> Iterator[tuple[float, str]]:
    """Call every kernel with data of the types of a real scan; see `daidalos.common.kernels.warm_up`."""
    yield 0.0, "log-odds grids"
    angles = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    ranges = (2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))).astype(np.float32)
    scan = LaserScanData(ranges, -np.pi, float(angles[1] - angles[0]), 0.0, 40.0)
    slam = HectorSlam(HectorConfig(map_size=256, map_multi_res_levels=2))
    ends = beam_ends(scan)
    slam.add_scan(scan, ends)
    yield 0.5, "scan matching"
    slam.add_scan(scan, ends)
