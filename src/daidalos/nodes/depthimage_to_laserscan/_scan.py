"""Nearest points of the middle rows of a depth image, by direction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Fan:
    """Rays of a scan in a camera's field of view; angles are positive to the left.

    Attributes
    ----------
    angle_min, angle_max, angle_increment : float
        Of the rays [rad].
    ranges : array of shape (width,)
        From the camera [m]; NaN where there is nothing to see, infinite where it is too far.
    """

    angle_min: float
    angle_max: float
    angle_increment: float
    ranges: NDArray[np.float32]


def scan(
    depth: NDArray[np.floating], fx: float, cx: float, range_min: float, range_max: float, scan_height: int
) -> Fan:
    """Return the scan of a depth image.

    Parameters
    ----------
    depth : array of shape (height, width)
        Along the optical axis [m]; 0 or not a number where it is not known.
    fx, cx : float
        Focal length across and column of the principal point [pixels].
    range_min, range_max : float
        Distances that count [m].
    scan_height : int
        How many rows around the middle one are looked at.
    """
    height, width = depth.shape
    first = max(0, height // 2 - scan_height // 2)
    rows = depth[first : first + scan_height].astype(np.float64)
    slopes = (np.arange(width) - cx) / fx
    angles = -np.arctan(slopes)
    angle_max, angle_min = float(angles[0]), float(angles[-1])
    increment = (angle_max - angle_min) / (width - 1)
    distances = rows * np.hypot(1.0, slopes)
    known = np.isfinite(rows) & (rows > 0)
    near = known & (distances >= range_min) & (distances <= range_max)
    rays = np.rint((angles - angle_min) / increment).astype(int)
    ranges = np.full(width, np.inf)
    np.minimum.at(ranges, np.broadcast_to(rays, rows.shape)[near], distances[near])
    far = np.zeros(width, dtype=bool)
    far[rays[(known & (distances > range_max)).any(axis=0)]] = True
    ranges[np.isinf(ranges) & ~far] = math.nan
    return Fan(angle_min, angle_max, increment, ranges.astype(np.float32))
