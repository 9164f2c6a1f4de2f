"""`ros2 control list_hardware_interfaces`."""

from __future__ import annotations

from argparse import Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, ask
from daidalos.cli.ros2.extension import Status


class ListHardwareInterfacesVerb(ControlVerb):
    """Output the list of available command and state interfaces."""

    def main(self, *, args: Namespace) -> Status:
        """Print the interfaces."""
        from controller_manager_msgs.srv import ListHardwareInterfaces

        with direct_node(args) as node:
            response = ask(node, args, ListHardwareInterfaces)
        print("command interfaces")
        for one in sorted(response.command_interfaces, key=lambda one: one.name):
            available = "available" if one.is_available else "unavailable"
            print(f"\t{one.name} [{available}] [{'claimed' if one.is_claimed else 'unclaimed'}]")
        print("state interfaces")
        for one in sorted(response.state_interfaces, key=lambda one: one.name):
            print(f"\t{one.name}")
        return 0
