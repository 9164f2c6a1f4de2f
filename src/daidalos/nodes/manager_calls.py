"""Calls of a controller manager's services, which wait as long as the manager may still come or answer."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.nodes.waiting import REPORT_S, answer, launch_is_running
from daidalos.transport.graph import EndpointKind, Graph

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.node import Node

_SPAWN_SERVICE = re.compile(r"/spawn_entity|/world/[^/]+/create")
"""Services of simulators that bring robots, and with them their controller managers."""

_LIST = "/list_controllers"


def call_manager(
    node: Node,
    service_type: Any,
    manager: str,
    service: str,
    request: Any,
    report: Callable[[str], object],
    *,
    coming_s: float | None = None,
    answer_s: float | None = None,
    for_ever: bool = False,
) -> Any:
    """Call a service of a controller manager and return its response.

    Parameters
    ----------
    node
        The node that calls.
    service_type
        The class of the service.
    manager
        The manager's full name.
    service
        The service's name within the manager.
    request
        The request.
    report
        Called every `REPORT_S` with what is waited for.
    coming_s
        How long the manager may take to come [s]. None: as long as a simulator, or the launch that started this
        process, is alive, but at least `REPORT_S`.
    answer_s
        How long the response may take [s]. None: as long as the manager is alive.
    for_ever
        Whether to wait for the manager, where `coming_s` is None, although nothing that may bring it is alive.

    Raises
    ------
    UserError
        When the manager does not come or does not answer.
    """
    client = node.create_client(service_type, f"{manager}/{service}")
    try:
        _wait_for_service(node.handle.graph, client, manager, report, coming_s, for_ever)
        return answer(client, request, report, answer_s)
    finally:
        node.destroy_client(client)


def _wait_for_service(
    graph: Graph, client: Client, manager: str, report: Callable[[str], object], limit_s: float | None, for_ever: bool
) -> None:
    if client.wait_for_service(REPORT_S if limit_s is None else limit_s):
        return
    if limit_s is not None:
        raise UserError(f"there was no controller manager '{manager}' within {limit_s:g} s{_others(graph, manager)}")
    while True:
        bringer = _bringer(graph, manager)
        if not (bringer or for_ever):
            raise UserError(
                f"there is no controller manager '{manager}', and no simulator is running that may bring one"
                f"{_others(graph, manager)}"
            )
        report(f"waiting for '{manager}'{f', as {bringer} is running' if bringer else ''}{_others(graph, manager)}")
        if client.wait_for_service(REPORT_S):
            return


def _bringer(graph: Graph, manager: str) -> str:
    """Return what is alive and may bring a controller manager; empty if there is nothing."""
    if launch_is_running():
        return "the launch"
    if any(node.full_name == manager for node in graph.nodes()):
        return "its node"
    spawning = [one for one in graph.endpoints(EndpointKind.SERVICE) if _SPAWN_SERVICE.fullmatch(one.name)]
    return f"the simulator '{spawning[0].node.full_name}'" if spawning else ""


def _others(graph: Graph, manager: str) -> str:
    known = [one.name for one in graph.endpoints(EndpointKind.SERVICE) if one.name.endswith(_LIST)]
    names = [name.removesuffix(_LIST) for name in known]
    return hint(manager, names) if names else ""
