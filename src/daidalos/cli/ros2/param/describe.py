"""`ros2 param describe`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import TYPE_NAMES

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import (
    add_node_arguments,
    add_timeout_argument,
    complete_parameters,
    describe_parameters,
    find_node,
    suggest,
)


class DescribeVerb(Verb):
    """Show descriptive information about declared parameters."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        complete_parameters(parser.add_argument("parameter_names", nargs="+", help="Names of the parameters"))
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print the descriptions."""
        with direct_node(args) as node:
            name = find_node(node, args)
            found = describe_parameters(node, name, args.parameter_names)
            for descriptor in found:
                print(description(descriptor))
            for unknown in set(args.parameter_names) - {descriptor.name for descriptor in found}:
                suggest(node, name, unknown)
        return 0


def description(descriptor: Any) -> str:
    """Return a `rcl_interfaces/msg/ParameterDescriptor` as text."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {TYPE_NAMES[descriptor.type]}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        lines += [f"    Min value: {limits.from_value}", f"    Max value: {limits.to_value}"]
        if limits.step:
            lines.append(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return "\n".join(lines)
