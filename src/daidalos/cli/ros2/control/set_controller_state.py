"""`ros2 control set_controller_state`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import (
    ControlVerb,
    add_controller_argument,
    configure,
    find_controller,
    switch,
)
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status


class SetControllerStateVerb(ControlVerb):
    """Adjust the state of the controller."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        add_controller_argument(parser, "Name of the controller to be changed")
        parser.add_argument(
            "state", choices=("inactive", "active"), help="State in which the controller should be changed to"
        )

    def main(self, *, args: Namespace) -> Status:
        """Configure, activate or deactivate it."""
        name = args.controller_name
        with direct_node(args) as node:
            before = find_controller(node, args, name).state
            if (before, args.state) == ("unconfigured", "inactive"):
                configure(node, args, name)
                print(f"Successfully configured {name}")
            elif (before, args.state) == ("active", "inactive"):
                switch(node, args, "Error stopping controller", deactivate=[name])
                print(f"Successfully deactivated {name}")
            elif (before, args.state) == ("inactive", "active"):
                switch(node, args, "Error activating controller", activate=[name])
                print(f"Successfully activated {name}")
            else:
                raise CliError(f"cannot put {name} in '{args.state}' state from its current state {before}")
        return 0
