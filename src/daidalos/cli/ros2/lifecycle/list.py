"""`ros2 lifecycle list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.lifecycles import add_node_arguments, find_managed, transitions


class ListVerb(Verb):
    """Output a list of available transitions."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        parser.add_argument("-a", "--all", action="store_true", help="Display all existing transitions")

    def main(self, *, args: Namespace) -> Status:
        """Print the transitions with their start and goal states."""
        with direct_node(args) as node:
            for found in transitions(node, find_managed(node.handle.graph, args), args.all):
                print(f"- {found.transition.label} [{found.transition.id}]")
                print(f"\tStart: {found.start_state.label}")
                print(f"\tGoal: {found.goal_state.label}")
        return 0
