"""`opennav_following`: the following server."""

from __future__ import annotations

from daidalos.nodes.opennav_following._following_server import FollowingServer
from daidalos.nodes.runner import run


def main() -> int:
    """Run the node."""
    return run(FollowingServer)
