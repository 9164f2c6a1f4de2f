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

    def _allows_interaction(self) -> bool:
        return False

    def _use(self, slam: Any) -> None:
        self._decay.reset()
        super()._use(slam)

    def _after_scan(self, result: Any) -> None:
        if result.added:
            removed = self._decay.update(self._slam)
            if removed:
                self._drawn_keys = -1
                self.get_logger().debug(f"removed {removed} key scans, {self._slam.key_count} are left")


def main() -> int:
    """Run the node."""
    return run(LifelongSlamToolbox)
