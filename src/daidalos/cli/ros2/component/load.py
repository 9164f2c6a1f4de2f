"""`ros2 component load`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.containers import add_component_arguments, add_container_argument, find_container, load
from daidalos.cli.ros2.extension import Status, Verb


class LoadVerb(Verb):
    """Load a component into a container node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_container_argument(parser)
        add_component_arguments(parser)
        parser.add_argument("-q", "--quiet", action="store_true", help="Use quiet output")

    def main(self, *, args: Namespace) -> Status:
        """Load the component, and print its number and node."""
        with direct_node(args) as node:
            container = find_container(node.handle.graph, args.container_node_name)
            number, name = load(node, container, args)
        if args.quiet:
            print(f"{number}  {name}")
        else:
            print(f"Loaded component {number} into '{container}' container node as '{name}'")
        return 0
