"""Compilation of every kernel of online SLAM ahead of its first use."""

from collections.abc import Iterator

import numpy as np

from daidalos.common import pose2
from daidalos.mapping.grid import ScanGrid
from daidalos.mapping.loop_closing import LoopCloser
from daidalos.mapping.pose_graph import Edge, optimize
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window
from daidalos.mapping.slam import SlamConfig


def steps() -> Iterator[tuple[float, str]]:
    """Call every kernel with data of the types of a real scan; see `daidalos.common.kernels.warm_up`."""
    yield 0.0, "laser scans"
    cloud = _square_room()
    placed = PointMap([cloud], np.zeros((1, 3)))
    yield 0.2, "correlation"
    placed.correlate(cloud.points, np.zeros(3), Window(0.5, 0.5))
    yield 0.4, "point to line"
    placed.refine(cloud.points, cloud.normals, np.zeros(3))
    yield 0.5, "occupancy grid"
    _draw(cloud)
    yield 0.7, "pose graph"
    _solve()
    yield 0.8, "loop closing"
    _close(cloud)


def _square_room() -> Cloud:
    angles = np.linspace(-np.pi, np.pi, 360, endpoint=False)
    ranges = (2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))).astype(np.float32)
    ranges[::50] = 30.0
    scan = LaserScanData(ranges, -np.pi, float(angles[1] - angles[0]), 0.0, 40.0)
    return to_cloud(scan, 20.0)


def _draw(cloud: Cloud) -> None:
    grid = ScanGrid(0.05)
    grid.add(cloud, np.zeros(3))
    grid.remove(cloud, np.zeros(3))
    grid.classify()


def _solve() -> None:
    chain = [Edge(k, k + 1, np.array([1.0, 0.0, 0.0]), np.eye(3)) for k in range(2)]
    optimize(
        np.zeros((3, 3)),
        [*chain, Edge(0, 2, np.array([2.0, 0.0, 0.0]), np.eye(3), closure=True)],
        chordal=True,
    )


def _close(cloud: Cloud) -> None:
    """Search closures of a robot that stands still and may have drifted."""
    config = SlamConfig()
    count = config.scan_buffer_size + 3 * config.loop_match_minimum_chain_size
    poses = np.zeros((count, 3))
    far = np.array([5.0, 0.0, 0.0])
    poses[count // 2] = far
    edges = [Edge(k, k + 1, pose2.between(poses[k], poses[k + 1]), np.eye(3)) for k in range(count - 1)]
    LoopCloser(config).search([cloud] * count, poses, edges)
