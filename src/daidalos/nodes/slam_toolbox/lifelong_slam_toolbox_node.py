"""`lifelong_slam_toolbox_node`: mapping that removes scans which newer ones replace."""

from __future__ import annotations

from typing import Any

from daidalos.mapping.lifelong import KeyScanDecay, LifelongConfig
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox


class LifelongSlamToolbox(SlamToolbox):
    """Node whose map does not grow while the robot stays in places that it knows."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._decay = KeyScanDecay(declare(self, LifelongConfig))

    def allows_interaction(self) -> bool:
        """Return False: scans that are removed cannot be moved."""
        return False

    def use(self, slam: Any) -> None:
        """Take a map in place of the one that there was, with new scores of its scans."""
        self._decay.reset()
        super().use(slam)

    def _after_scan(self, result: Any) -> None:
        if result.added:
            removed = self._decay.update(self.slam)
            if removed:
                self.drawn_keys = -1
                self.get_logger().debug(f"removed {removed} key scans, {self.slam.key_count} are left")


def main() -> int:
    """Run the node."""
    return run(LifelongSlamToolbox)
