"""`ros2 param load`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments
from ros2param.api import report

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.parameters import add_node_arguments, add_timeout_argument, find_node, set_parameters


class LoadVerb(Verb):
    """Load parameter file for a node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_node_arguments(parser)
        parser.add_argument("parameter_file", help="Parameter file")
        parser.add_argument(
            "--no-use-wildcard",
            action="store_true",
            help="Do not load parameters in the '/**' namespace into the node",
        )
        add_timeout_argument(parser)

    def main(self, *, args: Namespace) -> Status:
        """Set the parameters of the file, and print the result of each."""
        from rclpy.parameter import parameter_dict_from_yaml_file

        with direct_node(args) as node:
            name = find_node(node, args)
            try:
                parameters = parameter_dict_from_yaml_file(
                    args.parameter_file, use_wildcard=not args.no_use_wildcard, target_nodes=[name]
                )
            except OSError as error:
                raise CliError(f"{args.parameter_file}: {error.strerror}") from None
            results = set_parameters(node, name, list(parameters.values()))
        for parameter, result in zip(parameters, results, strict=True):
            report(result, f"Set parameter {parameter} successful", f"Set parameter {parameter} failed")
        return 0
