"""`ros2 component list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.containers import add_container_argument, containers, find_container, loaded
from daidalos.cli.ros2.extension import Status, Verb


class ListVerb(Verb):
    """Output a list of running containers and components."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_container_argument(parser, nargs="?")
        parser.add_argument("--containers-only", action="store_true", help="List found containers nodes only")

    def main(self, *, args: Namespace) -> Status:
        """Print the containers with their components, or only the components of a named container."""
        with direct_node(args) as node:
            graph = node.handle.graph
            name = args.container_node_name
            for container in [find_container(graph, name)] if name else containers(graph):
                if not name or args.containers_only:
                    print(container)
                if not args.containers_only:
                    for number, component in loaded(node, container):
                        print(f"{'' if name else '  '}{number}  {component}")
        return 0
