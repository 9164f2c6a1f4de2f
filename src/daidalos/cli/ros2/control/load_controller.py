"""`ros2 control load_controller`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, configure, load, switch
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.graph import absolute
from daidalos.cli.ros2.parameters import set_parameters

if TYPE_CHECKING:
    from rclpy.node import Node


_UNTIL_GALACTIC = {"configure": "inactive", "start": "active"}


def _state(word: str) -> str:
    """Return a state, also from the notation of distributions up to Galactic."""
    return _UNTIL_GALACTIC.get(word, word)


class LoadControllerVerb(ControlVerb):
    """Load a controller in a controller manager."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument("controller_name", help="Name of the controller")
        parser.add_argument("param_file", nargs="?", help="The YAML file with the controller parameters")
        parser.add_argument(
            "--set-state",
            type=_state,
            choices=("inactive", "active"),
            help="Set the state of the loaded controller",
        )

    def main(self, *, args: Namespace) -> Status:
        """Load the controller, and bring it to the requested state."""
        name = args.controller_name
        with direct_node(args) as node:
            if args.param_file:
                _set_parameters(node, args, name)
            load(node, args, name)
            if args.set_state is None:
                print(f"Successfully loaded controller {name}")
                return 0
            configure(node, args, name)
            if args.set_state == "active":
                switch(node, args, "Error activating controller", activate=[name])
        print(f"Successfully loaded controller {name} into state {args.set_state}")
        return 0


def _set_parameters(node: Node, args: Namespace, name: str) -> None:
    """Set the controller's type and parameter file on the manager."""
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value, parameter_dict_from_yaml_file

    try:
        wanted = parameter_dict_from_yaml_file(args.param_file, use_wildcard=True, target_nodes=[absolute(name)])
    except OSError as error:
        raise CliError(f"{args.param_file}: {error.strerror}") from None
    parameters = [Parameter(name=f"{name}.params_file", value=get_parameter_value(args.param_file))]
    if "type" in wanted:
        parameters.append(Parameter(name=f"{name}.type", value=wanted["type"].value))
    for result in set_parameters(node, absolute(args.controller_manager), parameters):
        if not result.successful:
            raise CliError(f"Could not set the parameters of controller {name}: {result.reason}")
