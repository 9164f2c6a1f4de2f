"""Simultaneous localization and mapping (SLAM) from laser scans and odometry, and localization in a saved map."""

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.mapping.back_end import Correction, GraphSnapshot, find_correction
from daidalos.mapping.config import SlamConfig
from daidalos.mapping.grid import OccupancyGrid, ScanGrid
from daidalos.mapping.loop_closing import LoopCloser
from daidalos.mapping.odometry import Accuracy, Drift, is_jump, twist_between
from daidalos.mapping.pose_graph import Edge, optimize, without_pose
from daidalos.mapping.pose_graph_file import SavedGraph
from daidalos.mapping.scan import Cloud, LaserScanData, scan_problem, to_cloud
from daidalos.mapping.scan_matching.matcher import PointMap
from daidalos.mapping.tracking import ScanMatch, find_pose, match_scan, nearest_scans, view_centres

__all__ = ["ScanResult", "Slam", "SlamConfig"]


MIN_POINTS = 10
"""Points that a scan must have to be matched."""

NEIGHBOURS = 10
"""Nearest key scans against which a robot that was put into the map is matched first."""

MOVED_DEVIATION = (0.05, 0.05, 0.02)
"""Standard deviations [m], [m], [rad] of a pose that a person gave to a key scan."""

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
    information : ndarray, shape (3, 3)
        Inverse covariance of the pose in the frame of the base.
    problem : str
        Why the scan could not be used, or what was wrong with its odometry; empty where nothing was.
    fits : bool
        Whether the scan agrees with the map around it; also true where it was not compared.
    """

    pose: Array
    matched: bool = False
    added: bool = False
    closed: bool = False
    optimized: bool = False
    information: Array = field(default_factory=lambda: np.zeros((3, 3)))
    problem: str = ""
    fits: bool = True

    @property
    def covariance(self) -> Array:
        """Covariance (3, 3) of the pose in the frame of the map; a direction that is not known has (10 m)^2."""
        cosine, sine = np.cos(self.pose[2]), np.sin(self.pose[2])
        turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        covariance: Array = turned @ np.linalg.inv(self.information + 0.01 * np.eye(3)) @ turned.T
        return covariance


@dataclass(frozen=True)
class _KeyScan:
    odom_pose: Array
    cloud: Cloud


class Slam:
    """Graph-based SLAM for a planar lidar and odometry.

    A scan is matched against the latest key scans; when the robot has moved far enough it becomes a key scan
    itself, with an edge in the pose graph. Key scans are matched against earlier ones nearby, and when such a
    closure disagrees with the poses so far, all of them are optimized and the grid follows, scan by scan.

    While `localizing` is set the map stays as it is: scans are matched against the key scans nearby and against a
    few of the latest ones, which are forgotten again.

    Parameters
    ----------
    config : SlamConfig, optional
        Distances, windows and thresholds.
    saved : SavedGraph, optional
        Map to go on from; `start_at` tells where the robot is in it.

    Attributes
    ----------
    localizing : bool
        Whether the map stays as it is.
    defers_closing : bool
        Whether loops are closed by `close_loops`, or its three steps, and not by `add_scan`, which then takes a time
        that does not grow with the graph.
    closing_is_due : bool
        Whether a key scan was added since loops were closed.

    Notes
    -----
    Not safe for use from several threads at once, `find_correction` excepted. The map's frame is odometry's frame at
    the first scan, or that of the saved map.
    """

    def __init__(self, config: SlamConfig | None = None, saved: SavedGraph | None = None) -> None:
        self.config = config if config is not None else SlamConfig()
        self._localizing = False
        self._keys: list[_KeyScan] = []
        self._poses = np.empty((64, 3))
        self._edges: list[Edge] = []
        self._closer = LoopCloser(self.config)
        self.defers_closing = False
        self.closing_is_due = False
        self._revision = 0
        self._local: PointMap | None = None
        self._last_pose = np.zeros(3)
        self._last_odom = np.zeros(3)
        self._last_stamp_ns = 0
        self._added_odom = np.zeros(3)
        self._added_stamp_ns = 0
        self._drift = Drift()
        self._accuracy = Accuracy()
        self._start: Array | None = None
        self._session_begin = 0
        self._neighbours: list[int] = []
        self._recent: deque[tuple[Cloud, Array]] = deque(maxlen=self.config.scan_buffer_size)
        self._grid = ScanGrid(self.config.resolution)
        self._drawn: list[Array] = []
        self._stale: list[int] = []
        if saved is not None:
            self._restore(saved)

    def _restore(self, saved: SavedGraph) -> None:
        self._keys = [_KeyScan(odom, cloud) for odom, cloud in zip(saved.odom_poses, saved.clouds, strict=True)]
        self._poses = np.array(saved.poses)
        self._edges = list(saved.edges)
        self._session_begin = len(self._keys)
        self._start = np.array(saved.poses[0])

    def reconfigure(self, config: SlamConfig) -> None:
        """Use other parameters from the next scan on; the map's resolution does not change."""
        self.config = self._closer.config = config
        self._recent = deque(self._recent, maxlen=config.scan_buffer_size)

    @property
    def localizing(self) -> bool:
        """Whether the map stays as it is."""
        return self._localizing

    @localizing.setter
    def localizing(self, value: bool) -> None:
        if value != self._localizing:
            self._localizing = value
            self._session_begin = len(self._keys)
            self.forget_recent()

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

    def saved(self) -> SavedGraph:
        """Return the key scans and the pose graph, to be written to files."""
        odom_poses = np.array([key.odom_pose for key in self._keys]).reshape(-1, 3)
        return SavedGraph(self.key_clouds, self.key_poses, odom_poses, self.edges, self.config.resolution)

    def start_at(self, pose: ArrayLike) -> None:
        """Take the robot to be about at a pose (x, y, yaw) of the map; the next scan finds it around there."""
        self._start = np.array(pose, dtype=np.float64)
        self.forget_recent()

    def start_at_first(self) -> None:
        """Take the robot to be where the first key scan was taken, such as at its dock."""
        self.start_at(self.key_pose(0))

    def start_at_odometry(self, map_to_odom: ArrayLike) -> None:
        """Take the robot to be where its odometry is in a frame that is known in the map."""
        self.start_at(pose2.compose(np.array(map_to_odom, dtype=np.float64), self._last_odom))

    def forget_recent(self) -> None:
        """Forget the latest scans that a robot is localized by beside the map."""
        self._recent.clear()
        self._local = None

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
        problem = scan_problem(scan)
        if problem:
            return self._unused(stamp_ns, odom, problem)
        if not self._keys or self._start is not None:
            return self._begin(stamp_ns, scan, odom)
        step = pose2.between(self._last_odom, odom)
        elapsed_ns = stamp_ns - self._last_stamp_ns
        if elapsed_ns < 0:
            problem = f"its time is {-1e-9 * elapsed_ns:.2f} s before that of the last scan"
        if is_jump(step, elapsed_ns):
            problem = f"odometry jumped by {np.hypot(step[0], step[1]):.2f} m and {step[2]:.2f} rad since the last scan"
            step = np.zeros(3)  # the robot cannot have moved like that
        twist = twist_between(step, elapsed_ns)
        predicted = pose2.compose(self._last_pose, step)
        self._drift = self._drift.after(step)
        self._last_pose, self._last_odom, self._last_stamp_ns = predicted, odom, stamp_ns
        # A stamp before the last one is a clock that was set back, not an early scan.
        is_early = 0 <= stamp_ns - self._added_stamp_ns < round(self.config.minimum_time_interval * 1e9)
        is_key = not is_early and self._has_moved(odom)
        if not (is_key or self.config.match_every_scan):
            return ScanResult(predicted, problem=problem, information=self._odometry_information())
        cloud = to_cloud(scan, self.config.max_laser_range, twist)
        if cloud.points.shape[0] < MIN_POINTS:
            return ScanResult(predicted, problem=problem or _too_few(cloud), information=self._odometry_information())
        certainty = self._odometry_information()
        match = match_scan(self._local_map(), cloud, predicted, self._drift, certainty, self.config, thorough=is_key)
        self._last_pose = match.pose
        information = match.information + certainty
        if match.accepted:
            if is_key:
                self._accuracy = self._accuracy.after(match.turned, self._drift)
            self._drift = Drift()
        fits = match.accepted or not self.config.use_scan_matching
        if not is_key:
            return ScanResult(match.pose, match.accepted, information=information, problem=problem, fits=fits)
        self._added_stamp_ns = stamp_ns
        if self._localizing:
            self._remember(cloud, odom)
            return ScanResult(match.pose, match.accepted, information=information, problem=problem, fits=fits)
        self._add_key(_KeyScan(odom, cloud), match)
        self.closing_is_due = self.config.do_loop_closing
        closed, optimized = (False, False) if self.defers_closing else self.close_loops()
        self._last_pose = self.key_pose(len(self._keys) - 1)
        return ScanResult(self._last_pose, match.accepted, True, closed, optimized, information, problem, fits)

    def _unused(self, stamp_ns: int, odom: Array, problem: str) -> ScanResult:
        """Follow odometry with a scan that cannot be used."""
        if not self._keys or self._start is not None:
            return ScanResult(odom if self._start is None else self._start, problem=problem)
        step = pose2.between(self._last_odom, odom)
        if is_jump(step, stamp_ns - self._last_stamp_ns):
            step = np.zeros(3)
        self._drift = self._drift.after(step)
        self._last_pose, self._last_odom = pose2.compose(self._last_pose, step), odom
        self._last_stamp_ns = stamp_ns
        return ScanResult(self._last_pose, problem=problem, information=self._odometry_information())

    def _odometry_edges(self) -> list[Edge]:
        """Return the motions by odometry between the key scans of this session; where wheels slipped they are false."""
        odom = np.array([key.odom_pose for key in self._keys[self._session_begin :]]).reshape(-1, 3)
        steps = pose2.between(odom[:-1], odom[1:])
        return [
            Edge(k, k + 1, step, self._motion_information(step), closure=True)
            for k, step in enumerate(steps, self._session_begin)
        ]

    def _motion_information(self, step: Array) -> Array:
        """Return the inverse covariance of a step (x, y, yaw) by odometry."""
        return self._accuracy.information(float(np.hypot(step[0], step[1])), abs(float(step[2])))

    def _odometry_information(self) -> Array:
        """Return the inverse covariance of the motion by odometry since a scan last corrected it."""
        return self._accuracy.information(self._drift.distance, self._drift.turn)

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

    def close_loops(self) -> tuple[bool, bool]:
        """Find loop closures of the newest key scan; return whether there are any, and whether they moved poses."""
        snapshot = self.snapshot_to_close()
        return (False, False) if snapshot is None else self.apply(self.find_correction(snapshot))

    def snapshot_to_close(self) -> GraphSnapshot | None:
        """Return a copy of the graph for `find_correction`, None where no key scan was added since the last one."""
        if not self.closing_is_due:
            return None
        self.closing_is_due = False
        return GraphSnapshot(self.key_clouds, self.key_poses, self.edges, self._revision)

    def find_correction(self, snapshot: GraphSnapshot) -> Correction | None:
        """Search loop closures in a copy of the graph; another thread may call the other methods meanwhile."""
        return find_correction(self._closer, snapshot)

    def apply(self, correction: Correction | None) -> tuple[bool, bool]:
        """Take over loop closures; return whether there were any, and whether they moved poses.

        Key scans that were added since the copy was made move with the one before them. A correction of a graph whose
        key scans were moved or removed since is left out; later scans find the closure again.
        """
        if correction is None or correction.snapshot.revision != self._revision:
            return False, False
        known = correction.snapshot
        self._edges = [*correction.edges, *self._edges[len(known.edges) :]]
        if correction.poses is None:
            return True, False
        since = self._poses[len(known.poses) : len(self._keys)]
        moved = pose2.compose(correction.poses[-1], pose2.between(known.poses[-1], since))
        self._move(np.concatenate([correction.poses, moved.reshape(-1, 3)]))
        return True, True

    def finish(self) -> None:
        """Optimize all poses after the last scan."""
        from daidalos.mapping.refinement import refine_poses

        if len(self._keys) > 1:
            self._move(refine_poses(self.key_clouds, self.key_poses, self._edges, self._odometry_edges()))

    def move_keys(self, poses: Mapping[int, Array]) -> None:
        """Put key scans where a person says that they were taken, and optimize the others; the first one stays.

        Parameters
        ----------
        poses : mapping of int to ndarray, shape (3,)
            Poses (x, y, yaw) in the map, by the index of the key scan.
        """
        first = self.key_pose(0)
        information = np.diag(1.0 / np.square(MOVED_DEVIATION))
        given = [
            Edge(0, index, pose2.between(first, pose), information)
            for index, pose in poses.items()
            if 0 < index < len(self._keys)
        ]
        if given:
            self._edges.extend(given)
            self._move(optimize(self.key_poses, self._edges, chordal=True).poses)

    def remove_keys(self, indices: Iterable[int]) -> None:
        """Remove key scans but the last one from the map, and tie their neighbours in the pose graph to each other."""
        for index in sorted(set(indices), reverse=True):
            if not 0 <= index < len(self._keys) - 1:
                continue
            self.render()
            self._grid.remove(self._keys[index].cloud, self._drawn.pop(index))
            self._edges = without_pose(self._edges, index)
            del self._keys[index]
            self._poses = np.delete(self._poses, index, axis=0)
            self._session_begin -= index < self._session_begin
            self._neighbours = [one - (one > index) for one in self._neighbours if one != index]
            self._closer.forget(index)
            self._revision += 1
        self._local = None

    def _begin(self, stamp_ns: int, scan: LaserScanData, odom: Array) -> ScanResult:
        """Start a map with the first scan, or find it in the map that there is."""
        cloud = to_cloud(scan, self.config.max_laser_range)
        guess = odom if self._start is None else self._start
        self._last_pose, self._last_odom, self._last_stamp_ns = guess, odom, stamp_ns
        if self._localizing and not self._keys:
            return ScanResult(odom, problem="there is no map to be localized in")
        if cloud.points.shape[0] < MIN_POINTS:
            return ScanResult(guess, problem=_too_few(cloud))
        self._added_stamp_ns, self._added_odom, self._drift = stamp_ns, odom, Drift()
        if not self._keys:
            self._keys.append(_KeyScan(odom, cloud))
            self._poses[0] = odom
            return ScanResult(odom, added=True)
        self._start = None
        return self._enter(cloud, guess, odom)

    def _enter(self, cloud: Cloud, guess: Array, odom: Array) -> ScanResult:
        """Find the first scan of a session in the map, around a guess of its pose."""
        poses = self.key_poses
        reach = self.config.scan_buffer_maximum_scan_distance
        self._neighbours = nearest_scans(guess, poses, NEIGHBOURS, reach).tolist()
        match = ScanMatch(guess, np.zeros((3, 3)), accepted=False)
        if self._neighbours:
            local = PointMap([self._keys[k].cloud for k in self._neighbours], poses[self._neighbours])
            match = find_pose(local, cloud, guess)
        problem = "" if match.accepted else f"does not fit the map near ({guess[0]:.2f}, {guess[1]:.2f})"
        self._last_pose, self._local = match.pose, None
        if self._localizing:
            self._remember(cloud, odom)
        else:
            self._session_begin = len(self._keys)
            self._add_key(_KeyScan(odom, cloud), match)
        return ScanResult(
            match.pose, match.accepted, not self._localizing, problem=problem, information=match.information
        )

    def _has_moved(self, odom: Array) -> bool:
        """Return whether odometry has moved far enough since a scan was added last."""
        x, y, turn = pose2.between(self._added_odom, odom)
        travelled = np.hypot(x, y) >= self.config.minimum_travel_distance
        return bool(travelled or abs(turn) >= self.config.minimum_travel_heading)

    def _local_map(self) -> PointMap:
        if self._local is None:
            if self._localizing:
                reach = self.config.scan_buffer_maximum_scan_distance
                members = nearest_scans(self._last_pose, self._poses[: len(self._keys)], NEIGHBOURS, reach)
            else:
                members = self._buffered()
            clouds = [self._keys[j].cloud for j in members] + [cloud for cloud, _ in self._recent]
            poses = np.array([*self._poses[members], *(pose for _, pose in self._recent)])
            self._local = PointMap(clouds, poses.reshape(-1, 3))
        return self._local

    def _buffered(self) -> NDArray[np.intp]:
        """Return the indices of the latest key scans, with those of the saved map while there are few."""
        newest = len(self._keys) - 1
        first = max(self._session_begin, newest - self.config.scan_buffer_size + 1)
        members = np.arange(first, newest + 1)
        if not len(members):
            reach = self.config.scan_buffer_maximum_scan_distance
            self._neighbours = nearest_scans(self._last_pose, self.key_poses, NEIGHBOURS, reach).tolist()
        if len(members) < self.config.scan_buffer_size:
            members = np.concatenate([np.array(self._neighbours, dtype=members.dtype), members])
        centres = view_centres(
            [self._keys[j].cloud for j in members], self._poses[members], barycenter=self.config.use_scan_barycenter
        )
        offset = centres - (centres[-1] if newest >= self._session_begin else self._last_pose[:2])
        near: NDArray[np.intp] = members[
            np.hypot(offset[:, 0], offset[:, 1]) <= self.config.scan_buffer_maximum_scan_distance
        ]
        return near

    def _remember(self, cloud: Cloud, odom: Array) -> None:
        """Keep a scan for a while, to be localized by beside the map."""
        self._recent.append((cloud, np.array(self._last_pose)))
        self._added_odom, self._local = odom, None

    def _add_key(self, key: _KeyScan, match: ScanMatch) -> None:
        """Add a key scan, tied to the last one; the first one of a session is tied to the nearest."""
        index = len(self._keys)
        is_first = index == self._session_begin
        first = int(nearest_scans(match.pose, self.key_poses, 1, np.inf)[0]) if is_first else index - 1
        if index == self._poses.shape[0]:
            self._poses = np.concatenate([self._poses, np.empty_like(self._poses)])
        self._poses[index] = match.pose
        measured = pose2.between(self._poses[first], match.pose)
        moved = self._motion_information(pose2.between(self._added_odom, key.odom_pose))
        self._edges.append(Edge(first, index, measured, match.information + moved))
        self._keys.append(key)
        self._added_odom, self._local = key.odom_pose, None

    def _move(self, poses: Array) -> None:
        """Set the key scans to the optimized poses, and move the robot with the last one."""
        newest = len(self._keys) - 1
        on_newest = pose2.between(self._poses[newest], self._last_pose)
        self._poses[: newest + 1] = poses
        self._revision += 1
        self._last_pose = pose2.compose(self._poses[newest], on_newest)
        self._local = None
        if self._drawn:
            gaps = pose2.between(np.array(self._drawn), self._poses[: len(self._drawn)])
            far = np.hypot(gaps[:, 0], gaps[:, 1]) > DRAWN_GAP * self.config.resolution
            self._stale = np.flatnonzero(far | (np.abs(gaps[:, 2]) > DRAWN_TURN)).tolist()


def _too_few(cloud: Cloud) -> str:
    return f"only {cloud.ends.shape[0]} of its ranges are measurements within the range limits"
