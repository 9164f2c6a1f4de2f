"""Simultaneous localization and mapping (SLAM) without odometry, after Kohlbrecher et al. 2011."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from daidalos.common.arrays import Array
from daidalos.common.pose2 import between
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.hector.config import HectorConfig
from daidalos.mapping.hector.log_odds_grid import GridMatch, LogOddsGrid
from daidalos.mapping.scan import LaserScanData, directions, scan_problem

__all__ = ["HectorConfig", "HectorResult", "HectorSlam", "beam_ends"]

COARSE_ITERATIONS, FINE_ITERATIONS = 8, 12
"""Iterations at most on each of the coarser grids, and on the finest one."""

WELL_FITTED = 0.1
"""Mean square misfit above which the search begins again with the robot turned."""

TURNS = (-0.5, -0.33, -0.17, 0.17, 0.33, 0.5)
"""Turns [rad] between two scans that are tried then: a lidar of 5 Hz on a robot that turns fast."""

MIN_POINTS = 10
"""Points that a scan must have to be matched."""

MIN_OVERLAP = 0.2
"""Share of the points that must lie where the map is known."""


@dataclass(frozen=True)
class HectorResult:
    """Result of one scan.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) of the base in the map.
    covariance : ndarray, shape (3, 3)
        Covariance of the pose in the frame of the map; a direction that is not known has (10 m)^2.
    updated : bool
        Whether the scan changed the map.
    problem : str
        Why the scan could not be used; empty where it could.
    """

    pose: Array
    covariance: Array
    updated: bool = False
    problem: str = ""


class HectorSlam:
    """SLAM for a planar lidar without odometry.

    A scan is matched against a pyramid of grids, from coarse to fine, from the pose of the scan before on; after a
    motion or turn it is drawn into all of them. There are no loop closures: what is drawn stays.

    Parameters
    ----------
    config : HectorConfig, optional
        Size of the map, and when scans change it.

    Notes
    -----
    Not safe for use from several threads at once. The map's frame is where the base is at the first scan.
    """

    def __init__(self, config: HectorConfig | None = None) -> None:
        self.config = c = config if config is not None else HectorConfig()
        side = c.map_size * c.map_resolution
        corner = (-c.map_start_x * side, -c.map_start_y * side)
        self._levels = [
            LogOddsGrid(-(-c.map_size // 2**level), c.map_resolution * 2**level, corner)
            for level in range(c.map_multi_res_levels)
        ]
        self._pose = np.zeros(3)
        self._covariance = np.zeros((3, 3))
        self._drawn: Array | None = None
        self.updates = 0

    @property
    def pose(self) -> Array:
        """Pose (x, y, yaw) of the base in the map at the last scan."""
        return self._pose.copy()

    def reconfigure(self, config: HectorConfig) -> None:
        """Continue with other thresholds and factors; the map keeps its size."""
        self.config = config

    def reset(self) -> None:
        """Forget the map and start at its frame again."""
        for level in self._levels:
            level.clear()
        self._pose, self._covariance, self._drawn = np.zeros(3), np.zeros((3, 3)), None
        self.updates += 1

    def add_scan(
        self, scan: LaserScanData, ends: Array, start: ArrayLike | None = None, *, pose_is_known: bool = False
    ) -> HectorResult:
        """Match a scan, and draw it into the map where the robot has moved far enough.

        Parameters
        ----------
        scan : LaserScanData
            The sweep.
        ends : ndarray, shape (n, 2)
            Those ends of its beams that are used, by `beam_ends`.
        start : array_like, optional
            Pose (x, y, yaw) to begin the search at; by default that of the scan before.
        pose_is_known : bool
            Whether that pose is kept as it is, and the scan drawn in any case.
        """
        problem = scan_problem(scan)
        if not problem and len(ends) < MIN_POINTS:
            problem = (
                f"only {len(ends)} of its {len(scan.ranges)} ranges are within the limits; {MIN_POINTS} are needed"
            )
        if problem:
            return self._result(problem=problem)
        begin = self._pose if start is None else np.array(start, dtype=np.float64)
        if pose_is_known or self._drawn is None:
            self._pose, self._covariance = begin.copy(), np.zeros((3, 3))
        else:
            problem = self._match(ends, begin)
            if problem:
                return self._result(problem=problem)
        moved = pose_is_known or self._has_moved()
        if moved:
            self._draw(ends, np.array(scan.sensor_pose[:2], dtype=np.float64))
        return self._result(updated=moved)

    def grid(self) -> OccupancyGrid:
        """Return the finest grid as occupied, free or unknown cells."""
        return self._levels[0].classify()

    def _match(self, ends: Array, begin: Array) -> str:
        """Move the pose to where the scan fits; return why it fits nowhere, an empty string where it does."""
        found = self._descend(ends, begin)
        if found.misfit > WELL_FITTED:
            turned = [self._descend(ends, begin + np.array([0.0, 0.0, turn])) for turn in TURNS]
            found = min(found, *turned, key=lambda match: match.misfit)
        if found.overlap < MIN_OVERLAP:
            return f"only {100 * found.overlap:.0f} % of its points lie where the map is known"
        self._pose = found.pose
        self._covariance = np.asarray(np.linalg.inv(found.information + 0.01 * np.eye(3)), dtype=np.float64)
        return ""

    def _descend(self, ends: Array, pose: Array) -> GridMatch:
        """Match from the coarsest grid to the finest."""
        for level in reversed(self._levels[1:]):
            pose = level.match(ends, pose, COARSE_ITERATIONS).pose
        return self._levels[0].match(ends, pose, FINE_ITERATIONS)

    def _has_moved(self) -> bool:
        if self._drawn is None:
            return True
        step = between(self._drawn, self._pose)
        far, turn = float(np.hypot(step[0], step[1])), abs(float(step[2]))
        return far > self.config.map_update_distance_thresh or turn > self.config.map_update_angle_thresh

    def _draw(self, ends: Array, origin: Array) -> None:
        free, occupied = _log_odds(self.config.update_factor_free), _log_odds(self.config.update_factor_occupied)
        for level in self._levels:
            level.update(ends, origin, self._pose, free, occupied)
        self._drawn = self._pose.copy()
        self.updates += 1

    def _result(self, *, updated: bool = False, problem: str = "") -> HectorResult:
        return HectorResult(self._pose.copy(), self._covariance.copy(), updated, problem)


def beam_ends(
    scan: LaserScanData,
    min_range: float = 0.0,
    max_range: float = np.inf,
    heights: tuple[float, float] = (-np.inf, np.inf),
) -> Array:
    """Return where the beams of a scan ended (n, 2), in the frame of the base [m].

    Parameters
    ----------
    scan : LaserScanData
        The sweep.
    min_range, max_range : float
        Distances [m] between which ends are used.
    heights : tuple of float
        Heights [m] over the sensor between which ends are used; those of a level sensor have the height 0.
    """
    ranges = np.asarray(scan.ranges, dtype=np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    roll, pitch = scan.sensor_tilt
    with np.errstate(invalid="ignore"):
        height = ranges * (np.cos(pitch) * np.sin(roll) * np.sin(angles) - np.sin(pitch) * np.cos(angles))
        used = np.isfinite(ranges) & (ranges > max(scan.range_min, min_range, 0.0))
        used &= (ranges < max_range) & (ranges <= scan.range_max)
        used &= (height > heights[0]) & (height < heights[1])
    ends: Array = np.array(scan.sensor_pose[:2]) + ranges[used, None] * directions(scan)[used]
    return ends


def _log_odds(probability: float) -> float:
    return float(np.log(probability / (1.0 - probability)))
