"""Compiling every kernel of online SLAM ahead of its first use."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daidalos.mapping import pose2
from daidalos.mapping.grid import ScanGrid
from daidalos.mapping.loop_closing import LoopCloser
from daidalos.mapping.pose_graph import Edge, optimize
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window
from daidalos.mapping.slam import SlamConfig

Array = NDArray[np.float64]


def warm_up(progress: Callable[[float, str], None] = lambda share, step: None) -> None:
    """Call every kernel once with data of the types of a real scan; see `daidalos.mapping.warm_up`."""
    progress(0.0, "laser scans")
    cloud = _square_room()
    placed = PointMap([cloud], np.zeros((1, 3)))
    steps: list[tuple[str, Callable[[], object]]] = [
        ("correlation", lambda: placed.correlate(cloud.points, np.zeros(3), Window(0.5, 0.5))),
        ("point to line", lambda: placed.refine(cloud.points, cloud.normals, np.zeros(3))),
        ("occupancy grid", lambda: _draw(cloud)),
        ("pose graph", _solve),
        ("loop closing", lambda: _close(cloud)),
    ]
    for done, (name, step) in enumerate(steps, 1):
        progress(done / (len(steps) + 1), name)
        step()
    progress(1.0, "ready")


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
    """Look for closures of a robot that stands still and is told that it may have drifted."""
    config = SlamConfig()
    count = config.scan_buffer_size + 3 * config.loop_match_minimum_chain_size
    poses = np.zeros((count, 3))
    far = np.array([5.0, 0.0, 0.0])
    poses[count // 2] = far
    edges = [Edge(k, k + 1, pose2.between(poses[k], poses[k + 1]), np.eye(3)) for k in range(count - 1)]
    LoopCloser(config).search([cloud] * count, poses, edges)
