"""`ros2 control reload_controller_libraries`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import add_manager_arguments, ask
from daidalos.cli.ros2.extension import Status, Verb


class ReloadControllerLibrariesVerb(Verb):
    """Reload controller libraries."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        parser.add_argument("--force-kill", action="store_true", help="Force stop of loaded controllers")
        add_manager_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Reload the libraries."""
        from controller_manager_msgs.srv import ReloadControllerLibraries

        with direct_node(args) as node:
            request = {"force_kill": args.force_kill}
            if not ask(node, args, "reload_controller_libraries", ReloadControllerLibraries, **request).ok:
                return "Error reloading libraries, check controller_manager logs"
        print("Reload successful")
        return 0
