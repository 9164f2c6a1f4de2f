"""Arguments of verbs about controllers and hardware."""

from __future__ import annotations

from argparse import REMAINDER, Action, ArgumentParser, Namespace
from collections.abc import Callable, Collection
from typing import Any

from ros2cli.node.direct import DirectNode
from ros2cli.services import call
from ros2node.api import NodeNameCompleter

_ALL_STATES = ("active", "inactive", "configured", "unconfigured")


class ControllerNameCompleter:
    """Completer of the controllers that the parameters of the controller manager declare."""

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        from rcl_interfaces.srv import ListParameters

        def names(node: Any) -> list[str]:
            service = f"{parsed_args.controller_manager}/list_parameters"
            found = call(node, ListParameters, service, ListParameters.Request()).result.names
            return [name.removesuffix(".type") for name in found if name.endswith(".type")]

        return _asked(parsed_args, names)


class LoadedControllerNameCompleter:
    """Completer of the loaded controllers.

    Parameters
    ----------
    valid_states
        States of those to offer.
    """

    def __init__(self, valid_states: Collection[str] = _ALL_STATES) -> None:
        self.valid_states = valid_states

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        from controller_manager import list_controllers

        def names(node: Any) -> list[str]:
            found = list_controllers(node, parsed_args.controller_manager).controller
            return [one.name for one in found if one.state in self.valid_states]

        return _asked(parsed_args, names)


class LoadedHardwareComponentNameCompleter:
    """Completer of the hardware components.

    Parameters
    ----------
    valid_states
        States of those to offer.
    """

    def __init__(self, valid_states: Collection[str] = _ALL_STATES) -> None:
        self.valid_states = valid_states

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        from controller_manager import list_hardware_components

        def names(node: Any) -> list[str]:
            found = list_hardware_components(node, parsed_args.controller_manager).component
            return [one.name for one in found if one.state.label in self.valid_states]

        return _asked(parsed_args, names)


class ParserROSArgs(Action):
    """Action of ``--ros-args``: stores it, with what follows, as ``argv``."""

    def __call__(
        self, parser: ArgumentParser, namespace: Namespace, values: Any, option_string: str | None = None
    ) -> None:
        """Store the arguments."""
        namespace.argv = [option_string, *values]


def add_controller_mgr_parsers(parser: ArgumentParser) -> None:
    """Declare the arguments of the controller manager."""
    manager = parser.add_argument(
        "-c",
        "--controller-manager",
        default="controller_manager",
        help="Name of the controller manager ROS node (default: controller_manager)",
    )
    manager.completer = NodeNameCompleter(  # type: ignore[attr-defined]  # argcomplete's
        include_hidden_nodes_key="include_hidden_nodes"
    )
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    parser.add_argument(
        "--ros-args", nargs=REMAINDER, action=ParserROSArgs, help="Pass arbitrary arguments to the executable"
    )


def _asked(parsed_args: Namespace, names: Callable[[Any], list[str]]) -> list[str]:
    """Return names that a node asks for; none where nobody answers."""
    try:
        with DirectNode(parsed_args) as node:
            return names(node)
    except RuntimeError:
        return []
