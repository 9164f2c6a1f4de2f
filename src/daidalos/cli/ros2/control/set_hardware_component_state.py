"""`ros2 control set_hardware_component_state`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, add_component_argument, ask
from daidalos.cli.ros2.extension import Status


class SetHardwareComponentStateVerb(ControlVerb):
    """Adjust the state of the hardware component."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        add_component_argument(parser, "Name of the hardware_component to be changed")
        parser.add_argument(
            "state",
            choices=("unconfigured", "inactive", "active"),
            help="State in which the hardware component should be changed to",
        )

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
            response = ask(node, args, SetHardwareComponentState, **request)
        if not response.ok:
            return f"Error setting hardware component to {args.state} state, check controller_manager logs"
        print(f"Successfully set {name} to state {response.state.label or args.state}")
        return 0
