"""`ros2 action type`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_actions
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, all_actions
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import print_types


class TypeVerb(Verb):
    """Print a action's type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_actions(
            parser.add_argument("action_name", help="Name of the ROS action to get type (e.g. '/fibonacci')")
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the types; the status is 1 if the action does not exist."""
        name = absolute(args.action_name)
        with graph_view(args) as graph:
            known = all_actions(graph)
        return print_types(known, name, "action")
