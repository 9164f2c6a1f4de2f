"""Calling services from verbs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.cli.ros2.errors import CliError

if TYPE_CHECKING:
    from rclpy.node import Node

READY_TIMEOUT_S = 5.0
_ANSWER_TIMEOUT_S = 10.0


def call(
    node: Node,
    service_type: Any,
    name: str,
    request: Any,
    *,
    ready_s: float = READY_TIMEOUT_S,
    answer_s: float | None = None,
) -> Any:
    """Return a service's response.

    Parameters
    ----------
    node
        Who calls.
    service_type, name, request
        What is called, and with what.
    ready_s
        How long to wait for somebody who serves it.
    answer_s
        How long to wait for the response; some seconds where None.

    Raises
    ------
    CliError
        When one of them takes too long.
    """
    client = node.create_client(service_type, name)
    try:
        if not client.wait_for_service(timeout_sec=ready_s):
            raise CliError(f"Wait for service '{name}' timed out after {ready_s:g} s: nobody serves it")
        limit = _ANSWER_TIMEOUT_S if answer_s is None else answer_s
        response = client.call(request, timeout_sec=limit)
    finally:
        node.destroy_client(client)
    if response is None:
        raise CliError(f"The service '{name}' did not answer within {limit:g} s")
    return response
