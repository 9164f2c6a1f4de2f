"""`ros2 daemon status`."""

from __future__ import annotations

from argparse import Namespace

from ros2cli.daemon import client

from daidalos.cli.ros2.extension import Status, Verb


class StatusVerb(Verb):
    """Output the status of the daemon."""

    def main(self, *, args: Namespace) -> Status:
        """Print the status."""
        print("The daemon is running" if client.is_running() else "The daemon is not running")
        return 0
