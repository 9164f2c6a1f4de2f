"""`ros2 node info`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from ros2cli.graph import NamesAndTypes, visible
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2node.api import INFO_NONUNIQUE_WARNING_TEMPLATE

from daidalos.cli.ros2.completion import complete_nodes
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, actions, nodes
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointKind, Graph, NodeInfo, names_and_types


class InfoVerb(Verb):
    """Output information about a node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_nodes(parser.add_argument("node_name", help="Node name to request information"))
        parser.add_argument(
            "--include-hidden",
            action="store_true",
            help="Display hidden topics, services, and actions as well",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the node's endpoints."""
        full_name = absolute(args.node_name)
        with graph_view(args) as graph:
            everyone = nodes(graph, args.include_hidden)
            found = [node for node in everyone if node.full_name == full_name]
            sections = _sections(graph, found[0], args.include_hidden) if found else {}
        if not found:
            hint = did_you_mean(full_name, (node.full_name for node in everyone))
            return f"Unable to find node '{args.node_name}'{hint}"
        if len(found) > 1:
            print(INFO_NONUNIQUE_WARNING_TEMPLATE.format(num_nodes=len(found), node_name=full_name), file=sys.stderr)
        print(full_name)
        for title, entries in sections.items():
            print(f"  {title}:")
            print("\n".join(f"    {name}: {', '.join(types)}" for name, types in entries))
        return 0


def _sections(graph: Graph, node: NodeInfo, include_hidden: bool) -> dict[str, NamesAndTypes]:
    def of(kind: EndpointKind) -> NamesAndTypes:
        return visible(names_and_types(graph.endpoints_of(node, kind)), include_hidden)

    def actions_by(kind: EndpointKind) -> NamesAndTypes:
        return visible(actions(graph.endpoints_of(node, kind)), include_hidden)

    return {
        "Subscribers": of(EndpointKind.SUBSCRIPTION),
        "Publishers": of(EndpointKind.PUBLISHER),
        "Service Servers": of(EndpointKind.SERVICE),
        "Service Clients": of(EndpointKind.CLIENT),
        "Action Servers": actions_by(EndpointKind.PUBLISHER),
        "Action Clients": actions_by(EndpointKind.SUBSCRIPTION),
    }
