"""`ros2 interface proto`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interface_arguments import KINDS, add_type_argument
from daidalos.cli.ros2.interfaces import action_class, message_class, service_class


class ProtoVerb(Verb):
    """Output an interface prototype."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_type_argument(parser, "Show an interface definition (e.g. 'example_interfaces/msg/String')")
        parser.add_argument("--no-quotes", action="store_true", help="if true output has no outer quotes.")

    def main(self, *, args: Namespace) -> Status:
        """Print a message, a request or a goal with default values."""
        from rosidl_runtime_py import message_to_yaml

        kind = next((part for part in args.type.split("/") if part in KINDS), "msg")
        fault = f"Could not find the interface '{args.type}'"
        if kind == "srv":
            message = service_class(args.type, fault).Request()
        elif kind == "action":
            message = action_class(args.type, fault).Goal()
        else:
            message = message_class(args.type, fault)()
        text = message_to_yaml(message)
        print(text if args.no_quotes else f'"{text}"')
        return 0
