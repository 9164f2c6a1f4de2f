"""Projection of laser scans into space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import LaserScan, PointCloud2, PointField
from sensor_msgs_py.point_cloud2 import create_cloud


class LaserProjection:
    """Projection of laser scans to point clouds; what depends on the rays' angles alone is computed once.

    Measurements below the scan's `range_min`, and from its `range_max` on, are left out, as are those that are not
    numbers.
    """

    LASER_SCAN_INVALID = -1.0
    LASER_SCAN_MIN_RANGE = -2.0
    LASER_SCAN_MAX_RANGE = -3.0

    class ChannelOption:
        """Channels of the points besides x, y and z; options are combined with ``|``."""

        NONE = 0x00
        """Nothing."""
        INTENSITY = 0x01
        """``intensity``, where the scan has it."""
        INDEX = 0x02
        """``index``: which measurement of the scan it was."""
        DISTANCE = 0x04
        """``distances``: from the scanner [m]."""
        TIMESTAMP = 0x08
        """``stamps``: after the scan's first measurement [s]."""
        VIEWPOINT = 0x10
        """``vp_x``, ``vp_y``, ``vp_z``: where the scanner was, the origin [m]."""
        DEFAULT = INTENSITY | INDEX
        """``intensity`` and ``index``."""

    def __init__(self) -> None:
        self._rays_of: tuple[float, float, int] | None = None
        self._rays: NDArray[np.float64] = np.empty((2, 0))

    def projectLaser(
        self, scan_in: LaserScan, range_cutoff: float = -1.0, channel_options: int = ChannelOption.DEFAULT
    ) -> PointCloud2:
        """Return the points of a scan, in the scan's frame.

        Parameters
        ----------
        scan_in
            The scan.
        range_cutoff
            Leaves out what is farther [m]; negative: only what the scan's `range_max` says.
        channel_options
            See `ChannelOption`.
        """
        ranges = np.asarray(scan_in.ranges, dtype=np.float32)
        limit = scan_in.range_max if range_cutoff < 0 else min(range_cutoff, scan_in.range_max)
        kept = np.flatnonzero((ranges >= scan_in.range_min) & (ranges < limit))
        distances = ranges[kept]
        x, y = self._unit_rays(scan_in, len(ranges))[:, kept] * distances
        columns: dict[str, Any] = {"x": x, "y": y, "z": 0.0}
        wanted = self.ChannelOption
        if channel_options & wanted.INTENSITY and len(scan_in.intensities) == len(ranges):
            columns["intensity"] = np.asarray(scan_in.intensities, dtype=np.float32)[kept]
        if channel_options & wanted.INDEX:
            columns["index"] = kept
        if channel_options & wanted.DISTANCE:
            columns["distances"] = distances
        if channel_options & wanted.TIMESTAMP:
            columns["stamps"] = kept * scan_in.time_increment
        if channel_options & wanted.VIEWPOINT:
            columns |= {"vp_x": 0.0, "vp_y": 0.0, "vp_z": 0.0}
        return _cloud(scan_in, len(kept), columns)

    def _unit_rays(self, scan: LaserScan, count: int) -> NDArray[np.float64]:
        """Return the cosines and sines of the rays' angles, (2, count)."""
        rays_of = (scan.angle_min, scan.angle_increment, count)
        if rays_of != self._rays_of:
            angles = scan.angle_min + scan.angle_increment * np.arange(count)
            self._rays, self._rays_of = np.array((np.cos(angles), np.sin(angles))), rays_of
        return self._rays


def _cloud(scan: LaserScan, count: int, columns: dict[str, Any]) -> PointCloud2:
    """Return a cloud of numbers of 4 bytes."""
    points = np.zeros(count, [(name, np.int32 if name == "index" else np.float32) for name in columns])
    for name, column in columns.items():
        points[name] = column
    fields = [
        PointField(
            name=name, offset=4 * place, datatype=PointField.INT32 if name == "index" else PointField.FLOAT32, count=1
        )
        for place, name in enumerate(columns)
    ]
    return create_cloud(scan.header, fields, points)
