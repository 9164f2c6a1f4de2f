"""`ros2 action info`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_actions
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, action_parties, actions, all_actions
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.common.suggestions import near_or_all
from daidalos.transport.graph import EndpointInfo, EndpointKind


class InfoVerb(Verb):
    """Print information about an action."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_actions(
            parser.add_argument("action_name", help="Name of the ROS action to get info (e.g. '/fibonacci')")
        )
        parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
        parser.add_argument(
            "-c", "--count", action="store_true", help="Only display the number of action clients and action servers"
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the clients and servers of the action."""
        name = absolute(args.action_name)
        with graph_view(args) as graph:
            clients = action_parties(graph, name, EndpointKind.SUBSCRIPTION)
            servers = action_parties(graph, name, EndpointKind.PUBLISHER)
            known = [other for other, _ in all_actions(graph)]
        print(f"Action: {name}")
        for title, parties in (("clients", clients), ("servers", servers)):
            print(f"Action {title}: {len(parties)}")
            if not args.count:
                _print_nodes(parties, args.show_types)
        if name not in known:
            sys.stderr.write(near_or_all(name, known, "actions"))
        return 0


def _print_nodes(parties: list[EndpointInfo], show_types: bool) -> None:
    for party in parties:
        types = ", ".join(kind for _, kinds in actions([party]) for kind in kinds)
        print(f"    {party.node.full_name}{f' [{types}]' if show_types else ''}")
