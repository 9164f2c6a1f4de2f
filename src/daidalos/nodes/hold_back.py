"""Holding back of a localization's transform while scans do not fit the map, so that whoever drives the robot stops."""

from __future__ import annotations

from rclpy.clock import Clock

from daidalos.nodes.scan_reports import ScanReports

HOLD_BACK_NS = 1_500_000_000
"""Time [ns] without a transform after a scan that does not fit: long enough for navigation to give its goal up."""


class HoldBack:
    """Time during which a transform is not published.

    Parameters
    ----------
    clock : Clock
    reports : ScanReports
        Reports the beginning, with the reason.
    frames : str
        The transform as it is named to the user, such as ``map -> odom``.
    """

    def __init__(self, clock: Clock, reports: ScanReports, frames: str) -> None:
        self._clock = clock
        self._reports = reports
        self._frames = frames
        self._until_ns = 0

    @property
    def is_active(self) -> bool:
        """Whether the transform is held back now."""
        left_ns = self._until_ns - self._clock.now().nanoseconds
        return 0 < left_ns <= HOLD_BACK_NS  # more is left where the clock was set back

    def begin(self, sensor_frame: str) -> None:
        """Hold the transform back from now on because of a scan in `sensor_frame`."""
        self._until_ns = self._clock.now().nanoseconds + HOLD_BACK_NS
        self._reports.report(
            "fit",
            f"a scan of '{sensor_frame}' does not fit the map: the robot may have been moved, or its odometry be "
            f"wrong; {self._frames} is not published for {1e-9 * HOLD_BACK_NS:g} s",
        )
