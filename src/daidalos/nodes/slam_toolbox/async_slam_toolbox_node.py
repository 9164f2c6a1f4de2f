"""`async_slam_toolbox_node`: map and robot pose from the latest scans, never behind the robot."""

from __future__ import annotations

from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox


class AsynchronousSlamToolbox(SlamToolbox):
    """Node that leaves scans out rather than fall behind."""


def main() -> int:
    """Run the node."""
    return run(AsynchronousSlamToolbox)
