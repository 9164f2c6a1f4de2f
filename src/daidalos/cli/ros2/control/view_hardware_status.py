"""`ros2 control view_hardware_status`."""

from __future__ import annotations

import functools
from argparse import ArgumentParser, Namespace
from typing import Any

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.graph import topics
from daidalos.cli.ros2.topics import spin, topic_class

_TYPE = "control_msgs/msg/HardwareStatus"


class ViewHardwareStatusVerb(ControlVerb):
    """Echo hardware status messages with filtering capabilities."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument("-i", "--hardware-id", help="Show only the status of this hardware component")
        parser.add_argument("-d", "--device-id", help="Show only the status of this device")

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
