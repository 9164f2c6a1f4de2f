"""`ros2 control list_controllers`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import Any

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, columns, list_controllers
from daidalos.cli.ros2.extension import Status

_COLORS = {"active": "\x1b[92m", "inactive": "\x1b[96m", "unconfigured": "\x1b[93m", "finalized": "\x1b[91m"}
_PLAIN = "\x1b[0m"


class ListControllersVerb(ControlVerb):
    """Output the list of loaded controllers, their type and status."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        for flag, text in (
            ("--claimed-interfaces", "List controller's claimed interfaces"),
            ("--required-state-interfaces", "List controller's required state interfaces"),
            ("--required-command-interfaces", "List controller's required command interfaces"),
            ("--chained-interfaces", "List interfaces that the controllers are chained to"),
            ("--reference-interfaces", "List controller's exported references"),
        ):
            parser.add_argument(flag, action="store_true", help=text)
        parser.add_argument(
            "--verbose",
            "-v",
            action="store_true",
            help="List controller's claimed interfaces, required state interfaces and required command interfaces",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the controllers."""
        with direct_node(args) as node:
            found = list_controllers(node, args)
        if not found:
            print("No controllers are currently loaded!")
            return 0
        lines = columns([(one.name, one.type) for one in found])
        width = max(map(len, lines))
        for line, one in zip(lines, found, strict=True):
            color = _COLORS.get(one.state, "") if sys.stdout.isatty() else ""
            print(f"{line:<{width}}  {color}{one.state}{_PLAIN if color else ''}")
            for title, names in _details(one, args):
                print(f"\t{title}:")
                for name in names:
                    print(f"\t\t{name}")
        return 0


def _details(controller: Any, args: Namespace) -> list[tuple[str, list[str]]]:
    """Return the details of the options: [(title, names)]."""
    chained = [f"{one.name}/{name}" for one in controller.chain_connections for name in one.reference_interfaces]
    sections = (
        ("claimed interfaces", controller.claimed_interfaces, args.claimed_interfaces),
        ("required command interfaces", controller.required_command_interfaces, args.required_command_interfaces),
        ("required state interfaces", controller.required_state_interfaces, args.required_state_interfaces),
        ("chained to interfaces", chained, args.chained_interfaces),
        ("exported reference interfaces", controller.reference_interfaces, args.reference_interfaces),
    )
    return [(title, list(names)) for title, names, asked in sections if asked or args.verbose]
