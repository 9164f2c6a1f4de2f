"""`ros2 control list_controller_types`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import add_manager_arguments, ask
from daidalos.cli.ros2.extension import Status, Verb


class ListControllerTypesVerb(Verb):
    """Output the available controller types and their base classes."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        add_manager_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print the controller types."""
        from controller_manager_msgs.srv import ListControllerTypes

        with direct_node(args) as node:
            response = ask(node, args, "list_controller_types", ListControllerTypes)
        for name, base in zip(response.types, response.base_classes, strict=True):
            print(f"{name:<70} {base}")
        return 0
