"""Client of the controller manager's services."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.completion import complete
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Verb
from daidalos.common.errors import UserError
from daidalos.common.names import snake_case
from daidalos.common.suggestions import did_you_mean

if TYPE_CHECKING:
    from rclpy.node import Node

DEFAULT_MANAGER = "controller_manager"
_COMPLETION_S = 1.0
"""How long the completion of names may wait for the manager [s]."""


class ControlVerb(Verb):
    """Verb that calls services of a controller manager."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of the node, the verb and the controller manager."""
        add_direct_arguments(parser)
        self.add_own_arguments(parser)
        _add_manager_arguments(parser)

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments that only this verb has."""


def _add_manager_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "-c",
        "--controller-manager",
        default=DEFAULT_MANAGER,
        help=f"Name of the controller manager ROS node (default: {DEFAULT_MANAGER})",
    )
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def ask(node: Node, args: Namespace, service_type: Any, *, coming_s: float | None = None, **request: Any) -> Any:
    """Return the response of one of the manager's services, such as ``list_controllers`` of type ``ListControllers``.

    It waits while something is alive that may bring the manager, and at most `coming_s` where that is given.

    Raises
    ------
    CliError
        When there is no such manager or it does not answer.
    """
    from daidalos.nodes.manager_calls import call_manager

    service = snake_case(service_type.__name__)
    manager = node.resolve_service_name(f"{args.controller_manager}/{service}").removesuffix(f"/{service}")
    message = service_type.Request(**request)
    try:
        return call_manager(node, service_type, manager, service, message, _report, coming_s=coming_s)
    except UserError as error:
        raise CliError(str(error)) from None


def _report(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def list_controllers(node: Node, args: Namespace, coming_s: float | None = None) -> list[Any]:
    """Return the controllers: `controller_manager_msgs/msg/ControllerState`; `coming_s` as in `ask`."""
    from controller_manager_msgs.srv import ListControllers

    return list(ask(node, args, ListControllers, coming_s=coming_s).controller)


def list_components(node: Node, args: Namespace, coming_s: float | None = None) -> list[Any]:
    """Return the hardware components: `controller_manager_msgs/msg/HardwareComponentState`; `coming_s` as in `ask`."""
    from controller_manager_msgs.srv import ListHardwareComponents

    return list(ask(node, args, ListHardwareComponents, coming_s=coming_s).component)


def find_controller(node: Node, args: Namespace, name: str) -> Any:
    """Return a loaded controller; CliError if it does not exist."""
    loaded = {one.name: one for one in list_controllers(node, args)}
    if name not in loaded:
        raise CliError(f"controller {name} does not seem to be loaded{did_you_mean(name, loaded)}")
    return loaded[name]


def configure(node: Node, args: Namespace, name: str) -> None:
    """Configure a controller."""
    from controller_manager_msgs.srv import ConfigureController

    if not ask(node, args, ConfigureController, name=name).ok:
        raise CliError("Error configuring controller, check controller_manager logs")


def load(node: Node, args: Namespace, name: str) -> None:
    """Load a controller."""
    from controller_manager_msgs.srv import LoadController

    if not ask(node, args, LoadController, name=name).ok:
        raise CliError(f"Error loading controller {name}, check controller_manager logs")


def switch(
    node: Node,
    args: Namespace,
    fault: str,
    *,
    activate: list[str] | None = None,
    deactivate: list[str] | None = None,
    strict: bool = True,
    asap: bool = True,
    timeout_s: float = 5.0,
) -> None:
    """Activate and deactivate controllers; CliError with `fault` and the manager's reason on failure."""
    from builtin_interfaces.msg import Duration
    from controller_manager_msgs.srv import SwitchController

    request = SwitchController.Request
    response = ask(
        node,
        args,
        SwitchController,
        activate_controllers=activate or [],
        deactivate_controllers=deactivate or [],
        strictness=request.STRICT if strict else request.BEST_EFFORT,
        activate_asap=asap,
        timeout=Duration(sec=int(timeout_s), nanosec=int(timeout_s % 1 * 1e9)),
    )
    if not response.ok:
        raise CliError(f"{fault}, check controller_manager logs{f': {response.message}' if response.message else ''}")


def add_controller_argument(parser: ArgumentParser, text: str, name: str = "controller_name", **options: Any) -> None:
    """Declare an argument that names a loaded controller."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        with direct_node(parsed_args) as node:
            return [one.name for one in list_controllers(node, parsed_args, _COMPLETION_S)]

    complete(parser.add_argument(name, help=text, **options), names)


def add_component_argument(parser: ArgumentParser, text: str) -> None:
    """Declare an argument that names a hardware component."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        with direct_node(parsed_args) as node:
            return [one.name for one in list_components(node, parsed_args, _COMPLETION_S)]

    complete(parser.add_argument("hardware_component_name", help=text), names)


def columns(rows: list[tuple[str, ...]]) -> list[str]:
    """Return rows of texts with their columns aligned."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(f"{text:<{width}}" for text, width in zip(row, widths, strict=True)).rstrip() for row in rows]
