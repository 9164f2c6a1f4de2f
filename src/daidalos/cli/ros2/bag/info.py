"""`ros2 bag info`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.bags.errors import BagError
from daidalos.cli.ros2.bag.arguments import add_bag_arguments, error, warn
from daidalos.cli.ros2.extension import Status, Verb


class InfoVerb(Verb):
    """Print information about a bag to the screen."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        add_bag_arguments(parser)
        parser.add_argument("-t", "--topic-name", action="store_true", help="Only display topic names")
        parser.add_argument(
            "-v",
            "--verbose",
            action="store_true",
            help="Also display the size of every topic and the requests and responses of every service; the whole "
            "bag is read for that",
        )
        parser.add_argument(
            "--sort",
            default="name",
            choices=["name", "type", "count"],
            help="By what topics are ordered (default: %(default)s)",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the content of the bag."""
        from rosbag2_py._format import contents, format_metadata, ordered

        from daidalos.bags.reader import BagReader

        if args.topic_name and args.verbose:
            warn("You have set both the '-t' and '-v' parameters. The '-t' parameter will be ignored.")
        try:
            with BagReader(args.bag_path, args.storage) as bag:
                for note in bag.notes:
                    warn(note)
                if args.topic_name and not args.verbose:
                    for one in ordered(bag.metadata.topics, args.sort):
                        if not one.topic.is_service_event:
                            print(one.topic.name)
                else:
                    found = contents(bag) if args.verbose else None
                    print(format_metadata(bag.metadata, bag.size, sort=args.sort, contents=found))
        except BagError as fault:
            raise error(str(fault)) from None
        return 0
