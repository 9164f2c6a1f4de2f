"""`ros2 param dump`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Iterable
from typing import Any

from daidalos.cli.ros2.direct import add_graph_arguments, direct_node
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    find_node,
    get_parameters,
    list_parameters,
)


class DumpVerb(Verb):
    """Show all of the parameters of a node in a YAML file format."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print a parameter file with the node's parameters."""
        import yaml
        from rclpy.parameter import parameter_value_to_python

        with direct_node(args) as node:
            name = find_node(node, args)
            names = list_parameters(node, name)
            values = map(parameter_value_to_python, get_parameters(node, name, names))
            tree = nested(zip(names, values, strict=True))
        print(yaml.safe_dump({name: {"ros__parameters": tree}}, default_flow_style=False))
        return 0


def nested(parameters: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return parameters as a tree: ``gains.p`` is ``p`` in ``gains``."""
    tree: dict[str, Any] = {}
    for name, value in parameters:
        branch = tree
        *groups, leaf = name.split(".")
        for group in groups:
            branch = branch.setdefault(group, {})
        branch[leaf] = value
    return tree
