"""`ros2 bag burst`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2bag.api import check_not_negative_int

from daidalos.bags.errors import BagError
from daidalos.cli.ros2.bag import arguments as common
from daidalos.cli.ros2.bag.play import run
from daidalos.cli.ros2.bag.qos_overrides import read_overrides
from daidalos.cli.ros2.extension import Status, Verb


class BurstVerb(Verb):
    """Burst data from a bag."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        common.add_bags_arguments(parser)
        common.add_topic_arguments(parser)
        common.add_start_offset(parser)
        parser.add_argument(
            "-n",
            "--num-messages",
            type=check_not_negative_int,
            default=0,
            metavar="N",
            help="Burst so many messages, then pause; 0 for all of them (default: %(default)s)",
        )

    def main(self, *, args: Namespace) -> Status:
        """Publish the burst, then follow the keyboard and the services."""
        from rosbag2_py import Player, PlayOptions

        bags = common.bags_to_play(args)
        options = PlayOptions(
            read_ahead_queue_size=args.read_ahead_queue_size,
            topics_to_filter=args.topics,
            services_to_filter=args.services,
            topic_qos_profile_overrides=read_overrides(args.qos_profile_overrides_path),
            topic_remapping_options=common.remapping_arguments(args.remap),
            start_paused=True,
            start_offset=args.start_offset,
        )
        try:
            player = Player(bags, options)
        except (BagError, ValueError) as fault:
            raise common.error(str(fault)) from None
        return run(player, args.num_messages)
