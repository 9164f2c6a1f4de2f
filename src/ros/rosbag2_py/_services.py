"""Services by which others control a recorder or a player."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node


def serve(
    node: Node, kind: Any, name: str, work: Callable[[Any], dict[str, Any] | None], group: CallbackGroup | None = None
) -> None:
    """Serve ``~/name``.

    Parameters
    ----------
    node
        Whose service it is.
    kind
        The service's class.
    name
        Its name, without the node's.
    work
        Takes a request and returns the fields of the response that are not as at first.
    group
        The callback group; the node's default where None.
    """

    def answer(request: Any, response: Any) -> Any:
        for field, value in (work(request) or {}).items():
            setattr(response, field, value)
        return response

    node.create_service(kind, f"~/{name}", answer, callback_group=group)
