"""Services by which others control a recorder or a player."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node


class Pausable(Protocol):
    """Recorder or player that can be paused and stopped."""

    @property
    def is_paused(self) -> bool: ...

    def pause(self) -> None: ...

    def resume(self) -> None: ...

    def toggle_paused(self) -> None: ...

    def stop(self) -> None: ...


def create_common_services(pausable: Pausable, node: Node, group: CallbackGroup | None = None) -> None:
    """Create the services that pause, resume and stop a recorder or a player, which is the node."""
    from rosbag2_interfaces import srv

    for kind, name, work in (
        (srv.IsPaused, "is_paused", lambda request: {"paused": pausable.is_paused}),
        (srv.Pause, "pause", lambda request: pausable.pause()),
        (srv.Resume, "resume", lambda request: pausable.resume()),
        (srv.TogglePaused, "toggle_paused", lambda request: pausable.toggle_paused()),
        (srv.Stop, "stop", lambda request: pausable.stop()),
    ):
        serve(node, kind, name, work, group)


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
