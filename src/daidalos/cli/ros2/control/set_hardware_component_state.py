"""`ros2 control set_hardware_component_state`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import add_component_argument, add_manager_arguments, ask
from daidalos.cli.ros2.extension import Status, Verb


class SetHardwareComponentStateVerb(Verb):
    """Adjust the state of the hardware component."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        add_component_argument(parser, "Name of the hardware_component to be changed")
        parser.add_argument(
            "state",
            choices=("unconfigured", "inactive", "active"),
            help="State in which the hardware component should be changed to",
        )
        add_manager_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Set the state, and print the resulting one."""
        from controller_manager_msgs.srv import SetHardwareComponentState
        from lifecycle_msgs.msg import State

        numbers = {
            "unconfigured": State.PRIMARY_STATE_UNCONFIGURED,
            "inactive": State.PRIMARY_STATE_INACTIVE,
            "active": State.PRIMARY_STATE_ACTIVE,
        }
        name = args.hardware_component_name
        target = State(id=numbers[args.state], label=args.state)
        with direct_node(args) as node:
            request = {"name": name, "target_state": target}
            response = ask(node, args, "set_hardware_component_state", SetHardwareComponentState, **request)
        if not response.ok:
            return f"Error setting hardware component to {args.state} state, check controller_manager logs"
        print(f"Successfully set {name} to state {response.state.label or args.state}")
        return 0
