"""Service calls of verbs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

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
    """Call a service and return its response.

    Parameters
    ----------
    node
        The node that calls.
    service_type
        The class of the service.
    name
        The name of the service.
    request
        The request.
    ready_s
        How long to wait for a server [s].
    answer_s
        How long to wait for the response [s]; `_ANSWER_TIMEOUT_S` where None.

    Raises
    ------
    RuntimeError
        When no server appears, or no response arrives, in time.
    """
    client = node.create_client(service_type, name)
    try:
        if not client.wait_for_service(timeout_sec=ready_s):
            raise RuntimeError(f"Wait for service '{name}' timed out after {ready_s:g} s: nobody serves it")
        limit = _ANSWER_TIMEOUT_S if answer_s is None else answer_s
        response = client.call(request, timeout_sec=limit)
    finally:
        node.destroy_client(client)
    if response is None:
        raise RuntimeError(f"The service '{name}' did not answer within {limit:g} s")
    return response
