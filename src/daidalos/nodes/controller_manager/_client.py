"""Client of a controller manager for the programs that control it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

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
        "--service-call-timeout", type=float, default=10.0, metavar="S", help="how long an answer may take"
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
        client = self._node.create_client(kind, f"{self.name}/{service}")
        try:
            self._wait(client)
            response = client.call(kind.Request(**request), self._call_s)
        except TimeoutError:
            response = None
        finally:
            self._node.destroy_client(client)
        if response is None:
            raise UserError(f"{self.name}/{service} did not answer within {self._call_s:g} s")
        return response

    def _wait(self, client: Any) -> None:
        if client.wait_for_service(self._wait_s or 10.0):
            return
        if self._wait_s:
            raise UserError(f"there was no controller manager '{self.name}' within {self._wait_s:g} s")
        while not client.wait_for_service(10.0):
            if not self._node.context.ok():
                raise ExternalShutdownException
            self._node.get_logger().warning(f"waiting for '{self.name}'")

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
