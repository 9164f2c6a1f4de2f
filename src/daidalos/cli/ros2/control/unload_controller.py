"""`ros2 control unload_controller`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, add_controller_argument, ask
from daidalos.cli.ros2.extension import Status


class UnloadControllerVerb(ControlVerb):
    """Unload a controller in a controller manager."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        add_controller_argument(parser, "Name of the controller")

    def main(self, *, args: Namespace) -> Status:
        """Unload the controller."""
        from controller_manager_msgs.srv import UnloadController

        with direct_node(args) as node:
            if not ask(node, args, UnloadController, name=args.controller_name).ok:
                return "Error unloading controllers, check controller_manager logs"
        print(f"Successfully unloaded controller {args.controller_name}")
        return 0
