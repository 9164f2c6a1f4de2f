"""Reports of scans that cannot be used: each reason at once, and again at most every ten seconds."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node

REPORT_INTERVAL_NS = 10_000_000_000
"""Time [ns] for which a reason that was reported is not reported again."""

LATE_NS = 1_000_000_000
"""Time [ns] after which a scan that still waits for a transform is reported."""

SILENCE_NS = 1_500_000_000
"""Time [ns] without any scan after which that is reported."""


class ScanReports:
    """Warnings of scans that cannot be used.

    Parameters
    ----------
    node
        Whose clock and log are used.
    """

    def __init__(self, node: Node) -> None:
        self._logger = node.get_logger()
        self._clock = node.get_clock()
        self._reported: dict[str, int] = {}
        self._unused: dict[str, int] = {}
        self.start()

    def start(self) -> None:
        """Count the time without scans from now on."""
        self._last_scan_ns = self.now_ns

    @property
    def now_ns(self) -> int:
        """Time [ns] of the node's clock."""
        return int(self._clock.now().nanoseconds)

    def came(self) -> None:
        """Record that a scan came."""
        self._last_scan_ns = self.now_ns

    def report(self, kind: str, text: str) -> None:
        """Warn, unless the same kind of trouble was reported a short time ago.

        Parameters
        ----------
        kind
            Tells reasons apart, such as ``transform``.
        text
            The warning.
        """
        self._unused[kind] = self._unused.get(kind, 0) + 1
        last_ns = self._reported.get(kind)
        if last_ns is not None and 0 <= self.now_ns - last_ns < REPORT_INTERVAL_NS:
            return
        repeated = f" ({self._unused[kind]} times since the last report)" if last_ns is not None else ""
        self._reported[kind], self._unused[kind] = self.now_ns, 0
        self._logger.warning(f"{text}{repeated}")

    def is_silent(self) -> bool:
        """Return whether no scan came for too long."""
        return self.now_ns - self._last_scan_ns > SILENCE_NS
