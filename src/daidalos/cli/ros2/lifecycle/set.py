"""`ros2 lifecycle set`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.lifecycles import add_node_arguments, change_state, find_managed, transitions


class SetVerb(Verb):
    """Trigger lifecycle state transition."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        complete(parser.add_argument("transition", help="The lifecycle transition"), _labels)

    def main(self, *, args: Namespace) -> Status:
        """Trigger the transition, named by its label or its number."""
        with direct_node(args) as node:
            name = find_managed(node.handle.graph, args)
            known = [found.transition for found in transitions(node, name)]
            wanted = [one for one in known if args.transition in (one.label, str(one.id))]
            if not wanted:
                listed = "".join(f"\n- {one.label} [{one.id}]" for one in known)
                raise CliError(f"Unknown transition requested, available ones are:{listed}")
            if not change_state(node, name, wanted[0]):
                return "Transitioning failed"
        print("Transitioning successful")
        return 0


def _labels(parsed_args: Namespace, **_: Any) -> list[str]:
    with direct_node(parsed_args) as node:
        name = find_managed(node.handle.graph, parsed_args, 0.0)
        return [found.transition.label for found in transitions(node, name)]
