"""Laser scans: conversion of ranges to points with normals in the frame of the robot's base."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

SPACING = 0.03
"""Least distance [m] of points in a row for matching: a near wall must not outweigh a far one."""

LINE_TOLERANCE = 0.05
"""Largest rms distance [m] of a point's neighbours from their line for the point to have a normal."""


@dataclass(frozen=True)
class LaserScanData:
    """Scan of a planar lidar, with the fields of `sensor_msgs/LaserScan`.

    Attributes
    ----------
    ranges : ndarray, shape (n,)
        Distances [m]; NaN, infinities, zeros and what is outside of [range_min, range_max] are no
        measurements.
    angle_min, angle_increment : float
        Direction of the first beam and step between beams [rad] in the sensor's frame.
    range_min, range_max : float
        Valid distances [m].
    time_increment : float
        Time between beams [s]; 0 where unknown.
    sensor_pose : tuple of float
        Pose (x, y, yaw) of the sensor in the frame of the base.
    sensor_tilt : tuple of float
        Roll and pitch [rad] of the sensor, applied before its yaw; a roll of pi is a lidar mounted upside down.
    sensor_height : float
        Height [m] of the sensor over the base.
    """

    ranges: NDArray[np.floating]
    angle_min: float
    angle_increment: float
    range_min: float = 0.0
    range_max: float = np.inf
    time_increment: float = 0.0
    sensor_pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sensor_tilt: tuple[float, float] = (0.0, 0.0)
    sensor_height: float = 0.0

    def lifted(self, height: float) -> Self:
        """Return the scan of a sensor that is higher by so much [m]."""
        return replace(self, sensor_height=self.sensor_height + height)


@dataclass(frozen=True)
class Cloud:
    """Points of one scan in the frame of the base at the time of its first beam.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        Where beams ended [m], thinned for matching.
    normals : ndarray, shape (n, 2)
        Unit normals of the surface towards the sensor; zero where the surroundings of a point are no line.
    ends : ndarray, shape (m, 2)
        Where all beams ended, for drawing.
    cleared : ndarray, shape (k, 2)
        Ends of beams that measured farther than the largest range that is used, cut to that range.
    origin : ndarray, shape (2,)
        Position of the sensor.
    """

    points: Array
    normals: Array
    ends: Array
    cleared: Array
    origin: Array


def scan_problem(scan: LaserScanData) -> str:
    """Return why a scan cannot be used, an empty string where it can."""
    if not len(scan.ranges):
        return "it has no ranges"
    for name in ("angle_min", "angle_increment"):
        if not np.isfinite(getattr(scan, name)):
            return f"its {name} is {getattr(scan, name)}"
    if scan.angle_increment == 0.0 and len(scan.ranges) > 1:
        return "its angle_increment is 0"
    if not scan.range_min <= scan.range_max:
        return f"its range_min ({scan.range_min:g}) is not below its range_max ({scan.range_max:g})"
    ranges = np.asarray(scan.ranges)
    with np.errstate(invalid="ignore"):
        usable = (ranges > 0.0) & np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
    if not usable.any():
        kinds = {
            "NaN": np.isnan(ranges),
            "infinite": np.isinf(ranges),
            "0": ranges == 0.0,
        }
        found = next((f"are {kind}" for kind, holds in kinds.items() if holds.all()), "are outside of its range limits")
        return f"all its {len(ranges)} ranges {found}"
    return ""


def to_cloud(scan: LaserScanData, max_range: float, twist: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Cloud:
    """Convert ranges to points with normals.

    Parameters
    ----------
    scan : LaserScanData
        The sweep.
    max_range : float
        Largest distance [m] at which an end point is used; longer beams only show free space up to there.
    twist : tuple of float
        Velocity (x [m/s], y [m/s], yaw [rad/s]) of the base in its own frame during the sweep; with a known
        `time_increment` every beam is moved to where it would have ended had the robot stood still.

    Returns
    -------
    Cloud
        Points, normals and cleared ends in the frame of the base at the first beam.
    """
    ranges = np.array(scan.ranges, dtype=np.float64)
    pose = np.array(scan.sensor_pose, dtype=np.float64)
    ends, normals, cleared = _ends_and_normals(
        ranges,
        directions(scan),
        abs(float(scan.angle_increment)),
        float(scan.range_min),
        float(scan.range_max),
        float(max_range),
        pose,
        np.array(twist, dtype=np.float64),
        float(scan.time_increment),
    )
    kept = _thin(ends)
    return Cloud(ends[kept], normals[kept], ends, cleared, pose[:2].copy())


def directions(scan: LaserScanData) -> Array:
    """Return the horizontal part (n, 2) of every beam's unit vector in the frame of the base."""
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    beams = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    roll, pitch = scan.sensor_tilt
    yaw = scan.sensor_pose[2]
    level = np.array([[np.cos(pitch), np.sin(pitch) * np.sin(roll)], [0.0, np.cos(roll)]])
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    horizontal: Array = np.ascontiguousarray(beams @ (turn @ level).T)
    return horizontal


@compiled
def _ends_and_normals(
    ranges: Array,
    directions: Array,
    increment: float,
    range_min: float,
    range_max: float,
    max_range: float,
    sensor: Array,
    twist: Array,
    time_increment: float,
) -> tuple[Array, Array, Array]:
    count = ranges.shape[0]
    points = np.empty((count, 2))
    reach = np.empty(count)
    cleared = np.empty((count, 2))
    hits = 0
    misses = 0
    for i in range(count):
        distance = ranges[i]
        if not (distance > 0.0 and range_min <= distance <= range_max and distance < np.inf):
            continue
        hit = distance <= max_range
        if not hit:
            distance = max_range
        x = sensor[0] + distance * directions[i, 0]
        y = sensor[1] + distance * directions[i, 1]
        elapsed = i * time_increment
        if elapsed > 0.0:
            yaw = twist[2] * elapsed
            cosine, sine = np.cos(yaw), np.sin(yaw)
            x, y = cosine * x - sine * y, sine * x + cosine * y
            # On the way the robot headed, on average, to where it headed after half of it.
            cosine, sine = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
            x += (cosine * twist[0] - sine * twist[1]) * elapsed
            y += (sine * twist[0] + cosine * twist[1]) * elapsed
        if hit:
            points[hits, 0] = x
            points[hits, 1] = y
            reach[hits] = distance
            hits += 1
        else:
            cleared[misses, 0] = x
            cleared[misses, 1] = y
            misses += 1
    points = points[:hits].copy()
    normals = _normals(points, reach[:hits], increment, sensor)
    return points, normals, cleared[:misses].copy()


@compiled
def _normals(points: Array, reach: Array, increment: float, sensor: Array) -> Array:
    """Compute normals as those of total least squares lines through each point's neighbours along the scan."""
    count = points.shape[0]
    normals = np.zeros((count, 2))
    for i in range(count):
        radius = max(0.1, 3.5 * reach[i] * increment)
        first = _end_of_surface(points, i, -1, radius)
        last = _end_of_surface(points, i, 1, radius)
        number = last - first + 1
        if number < 3:
            continue
        mx = points[first : last + 1, 0].mean()
        my = points[first : last + 1, 1].mean()
        xx = xy = yy = 0.0
        for j in range(first, last + 1):
            dx, dy = points[j, 0] - mx, points[j, 1] - my
            xx += dx * dx
            xy += dx * dy
            yy += dy * dy
        half = 0.5 * (xx - yy)
        root = np.sqrt(half * half + xy * xy)
        across = 0.5 * (xx + yy) - root
        along = 0.5 * (xx + yy) + root
        if across > number * LINE_TOLERANCE**2 or across > 0.2 * along:
            continue
        direction = 0.5 * np.arctan2(2.0 * xy, xx - yy)
        nx, ny = -np.sin(direction), np.cos(direction)
        if nx * (sensor[0] - points[i, 0]) + ny * (sensor[1] - points[i, 1]) < 0.0:
            nx, ny = -nx, -ny
        normals[i, 0] = nx
        normals[i, 1] = ny
    return normals


@compiled
def _end_of_surface(points: Array, start: int, step: int, radius: float) -> int:
    """Return the last index in one direction along the scan within the radius and without a jump."""
    i = start
    squared = radius * radius
    x, y = points[start, 0], points[start, 1]
    while 0 <= i + step < points.shape[0]:
        dx, dy = points[i + step, 0] - points[i, 0], points[i + step, 1] - points[i, 1]
        away_x, away_y = points[i + step, 0] - x, points[i + step, 1] - y
        if dx * dx + dy * dy > squared or away_x * away_x + away_y * away_y > squared:
            break
        i += step
    return i


@compiled
def _thin(points: Array) -> NDArray[np.int64]:
    """Return the indices of points that are a minimum distance apart from the last one kept."""
    kept = np.empty(points.shape[0], np.int64)
    count = 0
    for i in range(points.shape[0]):
        if count > 0:
            last = kept[count - 1]
            if np.hypot(points[i, 0] - points[last, 0], points[i, 1] - points[last, 1]) < SPACING:
                continue
        kept[count] = i
        count += 1
    return kept[:count].copy()
