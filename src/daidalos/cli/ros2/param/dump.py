"""`ros2 param dump`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import values_of

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    find_node,
    list_parameters,
)


class DumpVerb(Verb):
    """Show all of the parameters of a node in a YAML file format."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        add_timeout_argument(parser)
        parser.add_argument(
            "--output-dir", type=Path, help="Write the file there, named after the node, instead of printing it"
        )
        parser.add_argument("--print", action="store_true", help="Of no effect: it is printed unless it is written")

    def main(self, *, args: Namespace) -> Status:
        """Print a parameter file with the node's parameters."""
        import yaml
        from rclpy.parameter import parameter_value_to_python

        with direct_node(args) as node:
            name = find_node(node, args)
            names = list_parameters(node, name)
            values = map(parameter_value_to_python, values_of(node, name, names))
            tree = nested(zip(names, values, strict=True))
        text = yaml.safe_dump({name: {"ros__parameters": tree}}, default_flow_style=False)
        if args.output_dir is None:
            print(text)
            return 0
        file = args.output_dir / f"{name.lstrip('/').replace('/', '__')}.yaml"
        try:
            file.write_text(text, encoding="utf-8")
        except OSError as error:
            raise CliError(f"{file}: {error.strerror}") from None
        print(f"Saving to:  {file}")
        return 0


def nested(parameters: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return parameters as a tree: ``gains.p`` is ``p`` in ``gains``, unless ``gains`` is a parameter itself."""
    tree: dict[str, Any] = {}
    for name, value in sorted(parameters):
        branch = tree
        *groups, leaf = name.split(".")
        while groups and isinstance(branch.get(groups[0], {}), dict):
            branch = branch.setdefault(groups.pop(0), {})
        branch[".".join([*groups, leaf])] = value
    return tree
