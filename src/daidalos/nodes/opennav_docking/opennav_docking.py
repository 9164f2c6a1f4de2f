"""`opennav_docking`: the docking server."""

from __future__ import annotations

from daidalos.nodes.opennav_docking._docking_server import DockingServer
from daidalos.nodes.runner import run


def main() -> int:
    """Run the node."""
    return run(DockingServer)
