"""`ros2 control cleanup_controller`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import add_controller_argument, add_manager_arguments, ask
from daidalos.cli.ros2.extension import Status, Verb


class CleanupControllerVerb(Verb):
    """Cleanup a controller in a controller manager."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        add_controller_argument(parser, "Name of the controller")
        add_manager_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Clean up the controller."""
        from controller_manager_msgs.srv import CleanupController

        with direct_node(args) as node:
            if not ask(node, args, "cleanup_controller", CleanupController, name=args.controller_name).ok:
                return "Error cleaning up controller, check controller_manager logs"
        print(f"Successfully cleaned up controller {args.controller_name}")
        return 0
