"""Simultaneous localization and mapping (SLAM) from laser scans and odometry."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.config import SlamConfig
from daidalos.mapping.grid import OccupancyGrid, ScanGrid
from daidalos.mapping.loop_closing import LoopCloser
from daidalos.mapping.pose_graph import Edge, optimize
from daidalos.mapping.scan import Cloud, LaserScanData, to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap, Window
from daidalos.mapping.scan_matching.point_to_line import Refinement, match_information

__all__ = ["ScanResult", "Slam", "SlamConfig"]


MIN_POINTS = 10
"""Points that a scan must have to be matched."""

CERTAIN_INLIER_RATIO = 0.8
"""Part of the points on lines from which a match near the prediction needs no search."""

TOLERATED_GAP = 0.05
TOLERATED_TURN = 0.01
"""Disagreement [m], [rad] between a closure and the poses so far up to which optimizing can wait."""

BENT_GAP = 2.0
"""Disagreement [m] from which the poses are too bent to start an optimization from them alone."""

MAX_STEP_NS = 500_000_000
"""Time [ns] since the last scan after which odometry no longer tells how fast the robot moves now."""

DRAWN_GAP = 0.2
DRAWN_TURN = 0.002
"""How far a scan on the grid may be from where it should be, in cells and [rad], before it is drawn again."""


@dataclass(frozen=True)
class ScanResult:
    """Result of one scan.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) of the base in the map at the scan's stamp.
    matched : bool
        Whether the scan was matched; otherwise the pose is odometry's.
    added : bool
        Whether it became a key scan, a part of the map.
    closed : bool
        Whether a place seen before was recognized.
    optimized : bool
        Whether earlier poses moved.
    """

    pose: Array
    matched: bool = False
    added: bool = False
    closed: bool = False
    optimized: bool = False


@dataclass(frozen=True)
class _KeyScan:
    odom_pose: Array
    cloud: Cloud


@dataclass(frozen=True)
class _Match:
    pose: Array
    information: Array
    accepted: bool


class Slam:
    """Graph-based SLAM for a planar lidar and odometry.

    A scan is matched against the latest key scans; when the robot has moved far enough it becomes a key scan
    itself, with an edge in the pose graph. Key scans are matched against earlier ones nearby, and when such a
    closure disagrees with the poses so far, all of them are optimized and the grid follows, scan by scan.

    Parameters
    ----------
    config : SlamConfig, optional
        Distances, windows and thresholds.

    Notes
    -----
    Not safe for use from several threads at once. The map's frame is odometry's frame at the first scan.
    """

    def __init__(self, config: SlamConfig | None = None) -> None:
        self.config = config if config is not None else SlamConfig()
        self._keys: list[_KeyScan] = []
        self._poses = np.empty((64, 3))
        self._edges: list[Edge] = []
        self._closer = LoopCloser(self.config)
        self._local: PointMap | None = None
        self._last_pose = np.zeros(3)
        self._last_odom = np.zeros(3)
        self._last_stamp_ns = 0
        self._matched_stamp_ns = 0
        self._grid = ScanGrid(self.config.resolution)
        self._drawn: list[Array] = []
        self._stale: list[int] = []

    def reconfigure(self, config: SlamConfig) -> None:
        """Use other parameters from the next scan on; the map's resolution does not change."""
        self.config = self._closer.config = config

    @property
    def map_to_odom(self) -> Array:
        """Pose (x, y, yaw) of the odometry frame in the map."""
        return pose2.compose(self._last_pose, pose2.inverse(self._last_odom))

    @property
    def key_count(self) -> int:
        """Number of key scans."""
        return len(self._keys)

    @property
    def key_poses(self) -> Array:
        """Poses of the key scans in the map, shape (n, 3)."""
        return np.array(self._poses[: len(self._keys)])

    @property
    def key_clouds(self) -> list[Cloud]:
        """Points of the key scans in the frame of the base."""
        return [key.cloud for key in self._keys]

    def key_pose(self, index: int) -> Array:
        """Pose (x, y, yaw) of one key scan in the map."""
        return np.array(self._poses[index])

    @property
    def edges(self) -> list[Edge]:
        """The pose graph."""
        return list(self._edges)

    def add_scan(self, stamp_ns: int, scan: LaserScanData, odom_pose: ArrayLike) -> ScanResult:
        """Process one scan.

        Parameters
        ----------
        stamp_ns : int
            Time of the first beam [ns].
        scan : LaserScanData
            The ranges.
        odom_pose : array_like, shape (3,)
            Pose (x, y, yaw) of the base in the odometry frame at that time.

        Raises
        ------
        ValueError
            When the pose is not finite.
        """
        odom = np.array(odom_pose, dtype=np.float64)
        if odom.shape != (3,) or not np.isfinite(odom).all():
            raise ValueError(f"expected a finite odometry pose (x, y, yaw), found {odom.tolist()}")
        if not self._keys:
            return self._begin(stamp_ns, scan, odom)
        step = pose2.between(self._last_odom, odom)
        twist = self._twist(step, stamp_ns)
        predicted = pose2.compose(self._last_pose, step)
        self._last_pose, self._last_odom, self._last_stamp_ns = predicted, odom, stamp_ns
        is_key = self._has_moved(odom)
        # A stamp before the last one is a clock that was set back, not an early scan.
        early = 0 <= stamp_ns - self._matched_stamp_ns < round(self.config.minimum_time_interval * 1e9)
        if early or not (is_key or self.config.match_every_scan):
            return ScanResult(predicted)
        cloud = to_cloud(scan, self.config.max_laser_range, twist)
        if cloud.points.shape[0] < MIN_POINTS:
            return ScanResult(predicted)
        match = self._match(cloud, predicted, _odometry_information(step), thorough=is_key)
        self._matched_stamp_ns = stamp_ns
        self._last_pose = match.pose
        if not is_key:
            return ScanResult(match.pose, matched=match.accepted)
        self._add_key(_KeyScan(odom, cloud), match)
        closed, optimized = self._close_loops() if self.config.do_loop_closing else (False, False)
        self._last_pose = self.key_pose(len(self._keys) - 1)
        return ScanResult(self._last_pose, match.accepted, added=True, closed=closed, optimized=optimized)

    def grid(self, limit: int | None = None) -> OccupancyGrid:
        """Return the map, after at most `limit` scans were drawn or moved to where they belong."""
        self.render(limit)
        return self._grid.classify(self.config.occupancy_threshold, self.config.min_pass_through)

    def render(self, limit: int | None = None) -> int:
        """Draw or move at most `limit` scans on the grid; return the number of remaining ones."""
        waiting = [*range(len(self._drawn), len(self._keys)), *self._stale]
        count = len(waiting) if limit is None else min(limit, len(waiting))
        for index in waiting[:count]:
            pose, cloud = self.key_pose(index), self._keys[index].cloud
            if index < len(self._drawn):
                self._grid.remove(cloud, self._drawn[index])
                self._drawn[index] = pose
            else:
                self._drawn.append(pose)
            self._grid.add(cloud, pose)
        self._stale = [index for index in waiting[count:] if index < len(self._drawn)]
        return len(waiting) - count

    def finish(self) -> None:
        """Optimize all poses after the last scan."""
        from daidalos.mapping.refinement import refine_poses

        if len(self._keys) > 1:
            self._move(refine_poses(self.key_clouds, self.key_poses, self._edges))

    def _begin(self, stamp_ns: int, scan: LaserScanData, odom: Array) -> ScanResult:
        cloud = to_cloud(scan, self.config.max_laser_range)
        self._last_pose, self._last_odom, self._last_stamp_ns = odom, odom, stamp_ns
        if cloud.points.shape[0] < MIN_POINTS:
            return ScanResult(odom)
        self._matched_stamp_ns = stamp_ns
        self._keys.append(_KeyScan(odom, cloud))
        self._poses[0] = odom
        return ScanResult(odom, added=True)

    def _twist(self, step: Array, stamp_ns: int) -> tuple[float, float, float]:
        """Return the velocity of the base since the last scan by odometry; zero where that was too long ago."""
        elapsed_ns = stamp_ns - self._last_stamp_ns
        if not 0 < elapsed_ns < MAX_STEP_NS:
            return (0.0, 0.0, 0.0)
        x, y, yaw = (float(value) * 1e9 / elapsed_ns for value in step)
        return (x, y, yaw)

    def _has_moved(self, odom: Array) -> bool:
        """Return whether odometry has moved far enough since the last key scan."""
        x, y, turn = pose2.between(self._keys[-1].odom_pose, odom)
        travelled = np.hypot(x, y) >= self.config.minimum_travel_distance
        return bool(travelled or abs(turn) >= self.config.minimum_travel_heading)

    def _match(self, cloud: Cloud, predicted: Array, certainty: Array, *, thorough: bool) -> _Match:
        """Match a scan against the latest key scans; unless thorough, search only where it does not fit."""
        local = self._local_map()
        if not thorough:
            near = local.refine(cloud.points, cloud.normals, predicted, iterations=15)
            if near.inlier_ratio > CERTAIN_INLIER_RATIO:
                return _fuse(predicted, certainty, near)
        config = self.config
        window = Window(
            distance=0.5 * config.correlation_search_space_dimension,
            angle=config.coarse_search_angle_offset,
            distance_penalty=0.2 / config.distance_variance_penalty**2,
            angle_penalty=0.2 / config.angle_variance_penalty**2,
        )
        found = local.correlate(cloud.points, predicted, window)
        fine = local.refine(cloud.points, cloud.normals, predicted if found is None else found.pose)
        if fine.inlier_ratio < config.link_match_minimum_response_fine:
            return _Match(predicted, np.zeros((3, 3)), accepted=False)
        return _fuse(predicted, certainty, fine)

    def _local_map(self) -> PointMap:
        if self._local is None:
            newest = len(self._keys) - 1
            first = max(0, newest - self.config.scan_buffer_size + 1)
            offset = self._poses[first : newest + 1, :2] - self._poses[newest, :2]
            near = np.hypot(offset[:, 0], offset[:, 1]) <= self.config.scan_buffer_maximum_scan_distance
            members = first + np.flatnonzero(near)
            self._local = PointMap([self._keys[j].cloud for j in members], self._poses[members])
        return self._local

    def _add_key(self, key: _KeyScan, match: _Match) -> None:
        index = len(self._keys)
        if index == self._poses.shape[0]:
            self._poses = np.concatenate([self._poses, np.empty_like(self._poses)])
        self._poses[index] = match.pose
        measured = pose2.between(self._poses[index - 1], match.pose)
        moved = pose2.between(self._keys[-1].odom_pose, key.odom_pose)
        self._edges.append(Edge(index - 1, index, measured, match.information + _odometry_information(moved)))
        self._keys.append(key)
        self._local = None

    def _close_loops(self) -> tuple[bool, bool]:
        """Find loop closures of the newest key scan; return whether there are any, and whether they moved poses."""
        poses = self._poses[: len(self._keys)]
        closures = self._closer.search(self.key_clouds, poses, self._edges)
        if not closures:
            return False, False
        self._edges.extend(closures)
        measured = np.array([edge.measurement for edge in closures])
        gaps = pose2.between(measured, pose2.between(poses[[edge.first for edge in closures]], poses[-1]))
        gap, turn = np.hypot(gaps[:, 0], gaps[:, 1]).max(), np.abs(gaps[:, 2]).max()
        if gap < TOLERATED_GAP and turn < TOLERATED_TURN:
            return True, False
        solution = optimize(poses, self._edges, chordal=bool(gap > BENT_GAP))
        rejected = set(solution.rejected)
        self._edges = [edge for k, edge in enumerate(self._edges) if k not in rejected]
        self._move(solution.poses)
        return True, True

    def _move(self, poses: Array) -> None:
        """Set the key scans to the optimized poses, and move the robot with the last one."""
        newest = len(self._keys) - 1
        on_newest = pose2.between(self._poses[newest], self._last_pose)
        self._poses[: newest + 1] = poses
        self._last_pose = pose2.compose(self._poses[newest], on_newest)
        self._local = None
        if self._drawn:
            gaps = pose2.between(np.array(self._drawn), self._poses[: len(self._drawn)])
            far = np.hypot(gaps[:, 0], gaps[:, 1]) > DRAWN_GAP * self.config.resolution
            self._stale = np.flatnonzero(far | (np.abs(gaps[:, 2]) > DRAWN_TURN)).tolist()


def _fuse(predicted: Array, certainty: Array, match: Refinement) -> _Match:
    """Fuse a match with odometry, which constrains directions that lines do not, such as along a corridor."""
    information = match_information(match.normal_matrix)
    gap = pose2.between(match.pose, predicted)
    shift = np.linalg.solve(information + certainty, certainty @ gap)
    return _Match(pose2.compose(match.pose, shift), information, accepted=True)


def _odometry_information(moved: Array) -> Array:
    """Return the inverse covariance of a motion by odometry alone, assumed to be inaccurate."""
    distance, turn = float(np.hypot(moved[0], moved[1])), abs(float(moved[2]))
    deviation = np.array([0.05 + 0.2 * distance, 0.05 + 0.2 * distance, 0.2 + 0.2 * turn])
    return np.diag(1.0 / deviation**2)
