"""`ros2 control reload_controller_libraries`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, ask
from daidalos.cli.ros2.extension import Status


class ReloadControllerLibrariesVerb(ControlVerb):
    """Reload controller libraries."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument("--force-kill", action="store_true", help="Force stop of loaded controllers")

    def main(self, *, args: Namespace) -> Status:
        """Reload the libraries."""
        from controller_manager_msgs.srv import ReloadControllerLibraries

        with direct_node(args) as node:
            request = {"force_kill": args.force_kill}
            if not ask(node, args, ReloadControllerLibraries, **request).ok:
                return "Error reloading libraries, check controller_manager logs"
        print("Reload successful")
        return 0
