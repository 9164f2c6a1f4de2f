"""`ros2 pkg list`."""

from __future__ import annotations

from argparse import Namespace

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.packages import package_names


class ListVerb(Verb):
    """Output a list of available packages."""

    def main(self, *, args: Namespace) -> Status:
        """Print the names of the packages."""
        for name in package_names():
            print(name)
        return 0
