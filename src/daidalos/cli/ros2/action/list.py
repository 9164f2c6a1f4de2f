"""`ros2 action list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.direct import add_graph_arguments, graph_view
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import all_actions


class ListVerb(Verb):
    """Output a list of action names."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
        parser.add_argument(
            "-c", "--count-actions", action="store_true", help="Only display the number of actions discovered"
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the names as asked."""
        with graph_view(args) as graph:
            found = all_actions(graph)
        if args.count_actions:
            print(len(found))
            return 0
        for name, types in found:
            print(f"{name} [{', '.join(types)}]" if args.show_types else name)
        return 0
