"""`ros2 control list_hardware_components`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Iterator
from typing import Any

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, list_components
from daidalos.cli.ros2.extension import Status


class ListHardwareComponentsVerb(ControlVerb):
    """Output the list of available hardware components."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        parser.add_argument(
            "--verbose",
            "-v",
            action="store_true",
            help="List hardware components with command and state interfaces",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the hardware components."""
        with direct_node(args) as node:
            found = list_components(node, args)
        for number, component in enumerate(found, 1):
            print(f"Hardware Component {number}")
            print("\n".join(f"\t{line}" for line in _description(component, args.verbose)))
        return 0


def _description(component: Any, verbose: bool) -> Iterator[str]:
    yield f"name: {component.name}"
    yield f"type: {component.type}"
    yield f"plugin name: {component.plugin_name or 'plugin name missing!'}"
    yield f"state: id={component.state.id} label={component.state.label}"
    yield f"read/write rate: {component.rw_rate} Hz"
    yield f"is_async: {component.is_async}"
    yield "command interfaces"
    yield from _interfaces(component.command_interfaces)
    if verbose:
        yield "state interfaces"
        yield from _interfaces(component.state_interfaces, claimable=False)


def _interfaces(interfaces: Iterable[Any], claimable: bool = True) -> Iterator[str]:
    for one in interfaces:
        available = "[available]" if one.is_available else "[unavailable]"
        claimed = (" [claimed]" if one.is_claimed else " [unclaimed]") if claimable else ""
        yield f"\t{one.name} {available}{claimed}"
