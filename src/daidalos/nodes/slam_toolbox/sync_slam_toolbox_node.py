"""`sync_slam_toolbox_node`: map and robot pose from every scan, however long the queue grows."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox

_LONG_QUEUE = 10
"""Number of waiting scans that is reported."""


class SynchronousSlamToolbox(SlamToolbox):
    """Node that uses every scan, and serves ``slam_toolbox/clear_queue``."""

    keeps_every_scan = True

    def configure(self) -> None:
        """Serve the queue as well."""
        from slam_toolbox.srv import ClearQueue

        super().configure()
        self.create_service(ClearQueue, "slam_toolbox/clear_queue", self._on_clear_queue)

    def _on_scan(self, scan: Any) -> None:
        super()._on_scan(scan)
        if len(self._waiting) > _LONG_QUEUE and self.slam is not None:
            self._reports.report("queue", f"{len(self._waiting)} scans wait: the robot should stop until they are used")

    def _on_clear_queue(self, request: Any, response: Any) -> Any:
        count = len(self._waiting)
        self._waiting.clear()
        self.get_logger().info(f"removed {count} waiting scans")
        response.status = True
        return response


def main() -> int:
    """Run the node."""
    return run(SynchronousSlamToolbox)
