"""`ros2 component unload`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.containers import add_container_argument, find_container, unload
from daidalos.cli.ros2.extension import Status, Verb


class UnloadVerb(Verb):
    """Unload a component from a container node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_container_argument(parser)
        parser.add_argument("component_uid", nargs="+", type=int, help="Unique ID of the component to be unloaded")
        parser.add_argument("-q", "--quiet", action="store_true", help="Use quiet output")

    def main(self, *, args: Namespace) -> Status:
        """Unload components; the status is 1 if one could not be unloaded."""
        failed = False
        with direct_node(args) as node:
            container = find_container(node.handle.graph, args.container_node_name)
            for number in args.component_uid:
                fault = unload(node, container, number)
                failed = failed or bool(fault)
                if fault:
                    print(f"Failed to unload component {number} from '{container}' container node", file=sys.stderr)
                    print(f"    {fault}", file=sys.stderr)
                else:
                    print(number if args.quiet else f"Unloaded component {number} from '{container}' container node")
        return 1 if failed else 0
