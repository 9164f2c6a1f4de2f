"""`ros2 bag reindex`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.cli.ros2.bag.arguments import add_bag_arguments, error
from daidalos.cli.ros2.extension import Status, Verb


class ReindexVerb(Verb):
    """Reconstruct metadata file for a bag."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        add_bag_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Rewrite the description of the bag."""
        from rosbag2_py import Reindexer, StorageOptions

        if not Path(args.bag_path).is_dir():
            raise error("Must specify a bag directory")
        try:
            Reindexer().reindex(StorageOptions(args.bag_path, args.storage))
        except BagError as fault:
            raise error(str(fault)) from None
        return 0
