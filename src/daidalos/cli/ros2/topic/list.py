"""`ros2 topic list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import topics
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.listings import add_count_argument, add_hidden_argument, print_found
from daidalos.transport.graph import EndpointKind, Graph


class ListVerb(Verb):
    """Output a list of available topics."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the topic type")
        add_count_argument(parser, "topics")
        add_hidden_argument(parser, "topics")
        parser.add_argument(
            "-v",
            "--verbose",
            action="store_true",
            help="List full details about each topic",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the names, with types or as a number on request."""
        with graph_view(args) as graph:
            found = topics(graph, args.include_hidden_topics)
            if args.verbose:
                names = {name for name, _ in found}
                _print_side("Published topics:", "publisher", graph, EndpointKind.PUBLISHER, names)
                print()
                _print_side("Subscribed topics:", "subscriber", graph, EndpointKind.SUBSCRIPTION, names)
                print()
                return 0
        print_found(found, show_types=args.show_types, count=args.count_topics)
        return 0


def _print_side(title: str, what: str, graph: Graph, kind: EndpointKind, names: set[str]) -> None:
    """Print the topics of `names` with their publishers or their subscribers."""
    print(title)
    for name, types in topics(graph):
        count = len(graph.endpoints(kind, name=name))
        if name in names and count:
            print(f" * {name} [{', '.join(types)}] {count} {what}{'s' if count > 1 else ''}")
