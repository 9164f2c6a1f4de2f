"""`ros2 daemon stop`."""

from __future__ import annotations

from argparse import Namespace

from ros2cli.daemon import client

from daidalos.cli.ros2.extension import Status, Verb


class StopVerb(Verb):
    """Stop the daemon if it is running."""

    def main(self, *, args: Namespace) -> Status:
        """Stop the daemon."""
        print("The daemon has been stopped" if client.stop() else "The daemon is not running")
        return 0
