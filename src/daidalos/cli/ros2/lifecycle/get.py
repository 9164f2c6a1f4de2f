"""`ros2 lifecycle get`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.lifecycles import add_node_arguments, find_managed, managed_nodes, state


class GetVerb(Verb):
    """Get lifecycle state for one or more nodes."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser, nargs="?")

    def main(self, *, args: Namespace) -> Status:
        """Print the state of one node, or of every managed node with its name."""
        with direct_node(args) as node:
            graph = node.handle.graph
            if args.node_name:
                found = state(node, find_managed(graph, args))
                print(f"{found.label} [{found.id}]")
                return 0
            for name in managed_nodes(graph, args.include_hidden_nodes):
                found = state(node, name)
                print(f"{name}: {found.label} [{found.id}]")
        return 0
