"""`lifecycle_manager`: brings managed nodes up in their order, and down in the reverse."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

from daidalos.nodes.runner import run

_CONFIGURE, _CLEANUP, _ACTIVATE, _DEACTIVATE = 1, 2, 3, 4
_UNCONFIGURED, _INACTIVE, _ACTIVE = 1, 2, 3
_RETRY_S = 1.0


class LifecycleManager(Node):
    """Manages the nodes in its parameter ``node_names``; with ``autostart`` it begins by itself.

    A node that is not there yet is waited for, however long it takes: no order of starting and no slow
    machine makes the bring-up fail.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("lifecycle_manager", **kwargs)
        from nav2_msgs.srv import ManageLifecycleNodes
        from std_srvs.srv import Trigger

        self._names = [name for name in self.declare_parameter("node_names", [""]).value if name]
        autostart = self.declare_parameter("autostart", False).value
        self._clients: dict[tuple[str, str], Any] = {}
        self._active = False
        self._group = MutuallyExclusiveCallbackGroup()
        own = MutuallyExclusiveCallbackGroup()
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self._on_manage, callback_group=own)
        self.create_service(Trigger, "~/is_active", self._on_is_active)
        if autostart:
            self._start_timer = self.create_timer(0.0, self._autostart, callback_group=own)

    async def _autostart(self) -> None:
        self.destroy_timer(self._start_timer)
        await self._startup()

    async def _startup(self) -> bool:
        self.get_logger().info(f"starting {', '.join(self._names)}")
        for name in self._names:
            if not await self._bring(name, _INACTIVE, _CONFIGURE):
                return False
        for name in self._names:
            if not await self._bring(name, _ACTIVE, _ACTIVATE):
                return False
        self._active = True
        self.get_logger().info("Managed nodes are active")
        return True

    async def _bring(self, name: str, wanted: int, transition: int) -> bool:
        """Take a node through a transition unless it is where that leads already."""
        state = await self._state_of(name)
        if state == wanted or (wanted == _INACTIVE and state == _ACTIVE):
            return True
        if await self._change(name, transition):
            return True
        self.get_logger().error(f"'{name}' did not go through transition {transition}; the others are not started")
        return False

    async def _lower(self, transition: int, wanted: int) -> bool:
        for name in reversed(self._names):
            if await self._state_of(name) == wanted and not await self._change(name, transition):
                return False
        return True

    async def _state_of(self, name: str) -> int:
        from lifecycle_msgs.srv import GetState

        client = await self._ready_client(GetState, name, "get_state")
        response = await client.call_async(GetState.Request())
        return int(response.current_state.id)

    async def _change(self, name: str, transition: int) -> bool:
        from lifecycle_msgs.srv import ChangeState

        client = await self._ready_client(ChangeState, name, "change_state")
        request = ChangeState.Request()
        request.transition.id = transition
        response = await client.call_async(request)
        return bool(response.success)

    async def _ready_client(self, kind: Any, node: str, service: str) -> Any:
        key = (node, service)
        if key not in self._clients:
            name = f"{node}/{service}"
            self._clients[key] = self.create_client(kind, name, callback_group=self._group)
        client = self._clients[key]
        if not client.service_is_ready():
            await self._wait_for(client, node)
        return client

    async def _wait_for(self, client: Any, node: str) -> None:
        """Wait until the graph shows the service."""
        from rclpy.task import Future

        shown = Future()
        watcher = client.handle.node.session.watch(
            client.service_name,
            lambda added, endpoint: (
                shown.set_result(None) if added and not shown.done() and client.service_is_ready() else None
            ),
        )
        if client.service_is_ready() and not shown.done():
            shown.set_result(None)
        if not shown.done():
            self.get_logger().info(f"waiting for '{node}'", throttle_duration_sec=5.0)
        await shown
        watcher()

    async def _on_manage(self, request: Any, response: Any) -> Any:
        command = request.command
        if command == request.STARTUP or command == request.RESUME:
            response.success = await self._startup()
            return response
        self._active = False
        success = await self._lower(_DEACTIVATE, _ACTIVE)
        if command in (request.RESET, request.SHUTDOWN):
            success = await self._lower(_CLEANUP, _INACTIVE) and success
        response.success = success
        return response

    def _on_is_active(self, request: Any, response: Any) -> Any:
        response.success = self._active
        return response


def main() -> int:
    """Run the node."""
    return run(LifecycleManager)


if __name__ == "__main__":
    sys.exit(main())
