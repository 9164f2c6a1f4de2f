"""A controller manager's services as functions, for programs that have a node."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from controller_manager_msgs import srv
from lifecycle_msgs.msg import State
from rclpy.node import Node

from daidalos.common.names import snake_case


class ServiceNotFoundError(Exception):
    """The service is not there."""


class bcolors:
    """Escape sequences that colour a terminal's text."""

    MAGENTA, OKBLUE, OKCYAN, OKGREEN = "\033[95m", "\033[94m", "\033[96m", "\033[92m"
    WARNING, FAIL, ENDC, BOLD, UNDERLINE = "\033[93m", "\033[91m", "\033[0m", "\033[1m", "\033[4m"


def service_caller(
    node: Node,
    service_name: str,
    service_type: Any,
    request: Any,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
    max_attempts: int = 3,
) -> Any:
    """Return a service's answer.

    Parameters
    ----------
    node : Node
        It is spun meanwhile.
    service_name : str
    service_type, request
        The service's class and its request.
    service_timeout : float
        How long to wait for the service [s]; 0 waits without end.
    call_timeout : float
        How long an answer may take [s].
    max_attempts : int
        How often to ask.

    Raises
    ------
    ServiceNotFoundError
        When the service does not come.
    RuntimeError
        When it does not answer.
    """
    client = node.create_client(service_type, service_name)
    try:
        if not client.wait_for_service(service_timeout or None):
            raise ServiceNotFoundError(f"there was no service {service_name} within {service_timeout:g} s")
        for _ in range(max_attempts):
            future = client.call_async(request)
            rclpy.spin_until_future_complete(node, future, timeout_sec=call_timeout or None)
            if future.done():
                return future.result()
            client.remove_pending_request(future)
    finally:
        node.destroy_client(client)
    raise RuntimeError(f"{service_name} did not answer within {call_timeout:g} s, {max_attempts} times")


def _ask(node: Node, manager: str, kind: Any, service_timeout: float, call_timeout: float, /, **request: Any) -> Any:
    """Return the answer of the service that has the name of its type, such as ``list_controllers``."""
    service = f"{manager}/{snake_case(kind.__name__)}"
    return service_caller(node, service, kind, kind.Request(**request), service_timeout, call_timeout)


def list_controllers(
    node: Node, controller_manager_name: str, service_timeout: float = 0.0, call_timeout: float = 10.0
) -> Any:
    """Return the loaded controllers."""
    return _ask(node, controller_manager_name, srv.ListControllers, service_timeout, call_timeout)


def list_controller_types(
    node: Node, controller_manager_name: str, service_timeout: float = 0.0, call_timeout: float = 10.0
) -> Any:
    """Return the types of controllers that there are."""
    return _ask(node, controller_manager_name, srv.ListControllerTypes, service_timeout, call_timeout)


def list_hardware_components(
    node: Node, controller_manager_name: str, service_timeout: float = 0.0, call_timeout: float = 10.0
) -> Any:
    """Return the hardware."""
    return _ask(node, controller_manager_name, srv.ListHardwareComponents, service_timeout, call_timeout)


def list_hardware_interfaces(
    node: Node, controller_manager_name: str, service_timeout: float = 0.0, call_timeout: float = 10.0
) -> Any:
    """Return the hardware's interfaces."""
    return _ask(node, controller_manager_name, srv.ListHardwareInterfaces, service_timeout, call_timeout)


def load_controller(
    node: Node,
    controller_manager_name: str,
    controller_name: str,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Load a controller, whose type its manager's parameters say."""
    return _ask(node, controller_manager_name, srv.LoadController, service_timeout, call_timeout, name=controller_name)


def configure_controller(
    node: Node,
    controller_manager_name: str,
    controller_name: str,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Configure a controller that is loaded."""
    return _ask(
        node, controller_manager_name, srv.ConfigureController, service_timeout, call_timeout, name=controller_name
    )


def cleanup_controller(
    node: Node,
    controller_manager_name: str,
    controller_name: str,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Change a controller back to unconfigured."""
    return _ask(
        node, controller_manager_name, srv.CleanupController, service_timeout, call_timeout, name=controller_name
    )


def unload_controller(
    node: Node,
    controller_manager_name: str,
    controller_name: str,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Unload a controller that is not active."""
    return _ask(
        node, controller_manager_name, srv.UnloadController, service_timeout, call_timeout, name=controller_name
    )


def reload_controller_libraries(
    node: Node,
    controller_manager_name: str,
    force_kill: bool,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Unload all controllers; active ones only where they are to be stopped."""
    return _ask(
        node,
        controller_manager_name,
        srv.ReloadControllerLibraries,
        service_timeout,
        call_timeout,
        force_kill=force_kill,
    )


def set_hardware_component_state(
    node: Node,
    controller_manager_name: str,
    component_name: str,
    lifecyle_state: State,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Set the state of a hardware component."""
    request = {"name": component_name, "target_state": lifecyle_state}
    return _ask(node, controller_manager_name, srv.SetHardwareComponentState, service_timeout, call_timeout, **request)


def switch_controllers(
    node: Node,
    controller_manager_name: str,
    deactivate_controllers: Sequence[str],
    activate_controllers: Sequence[str],
    strict: bool,
    activate_asap: bool,
    timeout: float,
    service_timeout: float = 0.0,
    call_timeout: float = 10.0,
) -> Any:
    """Stop and start controllers: all or none where it is strict, else those that can be."""
    kind = srv.SwitchController
    return _ask(
        node,
        controller_manager_name,
        kind,
        service_timeout,
        call_timeout,
        deactivate_controllers=list(deactivate_controllers),
        activate_controllers=list(activate_controllers),
        strictness=kind.Request.STRICT if strict else kind.Request.BEST_EFFORT,
        activate_asap=activate_asap,
        timeout=Duration(sec=int(timeout), nanosec=round(timeout % 1 * 1e9) % 1_000_000_000),
    )
