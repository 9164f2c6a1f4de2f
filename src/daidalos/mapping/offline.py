"""Offline SLAM: map and trajectory of a recorded log."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.log import Log
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.slam import Slam, SlamConfig
from daidalos.mapping.trajectory import Stamps


@dataclass(frozen=True)
class LogMap:
    """Map and trajectory of a log.

    Attributes
    ----------
    grid : OccupancyGrid
        The map.
    poses : ndarray, shape (n, 3)
        Pose (x, y, yaw) of the base in the map at each scan of the log.
    key_scans, closures : int
        Number of scans that make up the map, and of recognized places.
    key_poses : ndarray, shape (m, 3)
        Poses of the key scans.
    edges : list of Edge
        The pose graph between them.
    trajectory_ns : ndarray of int64, shape (k,)
        Times [ns] of the scans and the odometry between them.
    trajectory : ndarray, shape (k, 3)
        Poses at those times, which follow odometry between the scans.
    """

    grid: OccupancyGrid
    poses: Array
    key_scans: int
    closures: int
    key_poses: Array
    edges: list[Edge]
    trajectory_ns: Stamps
    trajectory: Array


def map_log(log: Log, config: SlamConfig | None = None, progress: Callable[[int], None] = lambda done: None) -> LogMap:
    """Run SLAM over a log, matching every scan, and refine all poses at the end.

    Parameters
    ----------
    log : Log
        Scans and odometry.
    config : SlamConfig, optional
        Parameters; `match_every_scan` is always on.
    progress : callable
        Called with the number of scans done.
    """
    slam = Slam(replace(config or SlamConfig(), match_every_scan=True, minimum_time_interval=0.0))
    poses = np.empty((len(log.scans), 3))
    keys = np.empty(len(log.scans), dtype=np.int64)
    on_key = np.zeros((len(log.scans), 3))
    for index, scan in enumerate(log.scans):
        poses[index] = slam.add_scan(int(log.stamps_ns[index]), scan, log.odometry[index]).pose
        keys[index] = slam.key_count - 1
        if slam.key_count:
            on_key[index] = pose2.between(slam.key_pose(keys[index]), poses[index])
        progress(index + 1)
    if slam.key_count:
        slam.finish()
        # Key scans have moved since; what was found relative to them still holds.
        mapped = keys >= 0
        poses[mapped] = pose2.compose(slam.key_poses[keys[mapped]], on_key[mapped])
    closures = sum(edge.closure for edge in slam.edges)
    graph = slam.key_poses, list(slam.edges)
    return LogMap(slam.grid(), poses, slam.key_count, closures, *graph, *log.trajectory(poses))
