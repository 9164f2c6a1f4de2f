"""Client of a controller manager for the programs that control it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node

from daidalos.nodes.manager_calls import call_manager
from daidalos.nodes.runner import UserError


def add_manager_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare which manager is meant and how long it may take."""
    parser.add_argument(
        "-c", "--controller-manager", default="controller_manager", help="name of the controller manager's node"
    )
    parser.add_argument(
        "--controller-manager-timeout",
        type=float,
        default=0.0,
        metavar="S",
        help="how long to wait for the controller manager; 0 waits without end",
    )
    parser.add_argument("--switch-timeout", type=float, default=5.0, metavar="S", help="how long switching may take")
    parser.add_argument(
        "--service-call-timeout",
        type=float,
        metavar="S",
        help="how long an answer may take; as long as the controller manager is alive where it is not given",
    )


class ManagerClient:
    """Client of a controller manager's services.

    Parameters
    ----------
    node : Node
    arguments : argparse.Namespace
        What `add_manager_arguments` declared.
    """

    def __init__(self, node: Node, arguments: argparse.Namespace) -> None:
        self._node = node
        self.name = _full_name(arguments.controller_manager, node.get_namespace())
        self._wait_s = arguments.controller_manager_timeout
        self._call_s = arguments.service_call_timeout
        self._switch_s = arguments.switch_timeout

    def ask(self, kind: Any, service: str, **request: Any) -> Any:
        """Return the answer of one of its services.

        Raises
        ------
        UserError
            When it is not there or does not answer.
        """
        return call_manager(
            self._node,
            kind,
            self.name,
            service,
            kind.Request(**request),
            self._node.get_logger().warning,
            coming_s=self._wait_s or None,
            answer_s=self._call_s,
            for_ever=True,
        )

    def controllers(self) -> dict[str, Any]:
        """Return the loaded controllers by name."""
        from controller_manager_msgs.srv import ListControllers

        return {one.name: one for one in self.ask(ListControllers, "list_controllers").controller}

    def set_parameter(self, name: str, value: Any) -> None:
        """Set one of its parameters."""
        from rcl_interfaces.msg import Parameter
        from rcl_interfaces.srv import SetParameters
        from rclpy.parameter import Parameter as Value

        message: Parameter = Value(name, value=value).to_parameter_msg()
        result = self.ask(SetParameters, "set_parameters", parameters=[message]).results[0]
        if not result.successful:
            raise UserError(f"{self.name} does not take the parameter '{name}': {result.reason}")

    def switch(self, start: Sequence[str] = (), stop: Sequence[str] = (), asap: bool = True) -> str:
        """Start and stop controllers, all or none; return why that cannot be, nothing when it was done."""
        from builtin_interfaces.msg import Duration
        from controller_manager_msgs.srv import SwitchController

        response = self.ask(
            SwitchController,
            "switch_controller",
            activate_controllers=list(start),
            deactivate_controllers=list(stop),
            strictness=SwitchController.Request.STRICT,
            activate_asap=asap,
            timeout=Duration(sec=int(self._switch_s), nanosec=int(self._switch_s % 1 * 1e9)),
        )
        return "" if response.ok else response.message or "see the controller manager's log"


def _full_name(name: str, namespace: str) -> str:
    return name if name.startswith("/") else f"{namespace.rstrip('/')}/{name}"
