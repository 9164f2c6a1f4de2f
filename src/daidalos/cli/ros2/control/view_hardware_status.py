"""`ros2 control view_hardware_status`."""

from __future__ import annotations

import functools
from argparse import ArgumentParser, Namespace
from typing import Any

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import add_manager_arguments
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import topics
from daidalos.cli.ros2.topics import spin, topic_class

_TYPE = "control_msgs/msg/HardwareStatus"


class ViewHardwareStatusVerb(Verb):
    """Echo hardware status messages with filtering capabilities."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        parser.add_argument("-i", "--hardware-id", help="Show only the status of this hardware component")
        parser.add_argument("-d", "--device-id", help="Show only the status of this device")
        add_manager_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Print every status until Ctrl-C."""
        with direct_node(args) as node:
            names = [name for name, types in topics(node.handle.graph) if _TYPE in types]
            if not names:
                raise CliError(f"No hardware publishes its status: there is no topic of type {_TYPE}")
            for name in names:
                show = functools.partial(_show, args, name)
                node.create_subscription(topic_class(node, name), name, show, 10)
            spin(node)
        return 0


def _show(args: Namespace, topic: str, message: Any) -> None:
    from rosidl_runtime_py import message_to_yaml

    if args.hardware_id not in (None, message.hardware_id):
        return
    if args.device_id is not None:
        devices = [one for one in message.hardware_device_states if one.device_id == args.device_id]
        if not devices:
            return
        message.hardware_device_states = devices
    print(f"{topic}:\n{message_to_yaml(message)}---")
