"""`ros2 control list_controller_types`."""

from __future__ import annotations

from argparse import Namespace

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, ask
from daidalos.cli.ros2.extension import Status


class ListControllerTypesVerb(ControlVerb):
    """Output the available controller types and their base classes."""

    def main(self, *, args: Namespace) -> Status:
        """Print the controller types."""
        from controller_manager_msgs.srv import ListControllerTypes

        with direct_node(args) as node:
            response = ask(node, args, ListControllerTypes)
        for name, base in zip(response.types, response.base_classes, strict=True):
            print(f"{name:<70} {base}")
        return 0
