"""`lifecycle_manager`: starts managed nodes in order, and stops them in reverse."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare

_INACTIVE, _ACTIVE = 2, 3


class _Transition(IntEnum):
    """Transitions of managed nodes, by lifecycle_msgs' numbers."""

    CONFIGURE = 1
    CLEANUP = 2
    ACTIVATE = 3
    DEACTIVATE = 4


@dataclass(frozen=True)
class LifecycleManagerParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    node_names: tuple[str, ...] = parameter(("",), "Nodes that are managed, in the order of their start.")
    autostart: bool = parameter(False, "Whether the nodes are started at once.")


class LifecycleManager(Node):
    """Manages the nodes in its parameter ``node_names``; with ``autostart`` it begins by itself.

    A node that is not there yet is waited for, however long it takes: no order of starting and no slow
    machine makes the bring-up fail.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("lifecycle_manager", **kwargs)
        from nav2_msgs.srv import ManageLifecycleNodes
        from std_srvs.srv import Trigger

        parameters = declare(self, LifecycleManagerParameters)
        self._names = [name for name in parameters.node_names if name]
        self._clients: dict[tuple[str, str], Any] = {}
        self._active = False
        self._group = MutuallyExclusiveCallbackGroup()
        own = MutuallyExclusiveCallbackGroup()
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self._on_manage, callback_group=own)
        self.create_service(Trigger, "~/is_active", self._on_is_active)
        if parameters.autostart:
            self._start_timer = self.create_timer(0.0, self._autostart, callback_group=own)

    async def _autostart(self) -> None:
        self.destroy_timer(self._start_timer)
        await self._startup()

    # Commands.

    async def _configure(self) -> bool:
        return await self._raise(_Transition.CONFIGURE, {_INACTIVE, _ACTIVE})

    async def _startup(self) -> bool:
        self.get_logger().info(f"starting {', '.join(self._names)}")
        if not (await self._configure() and await self._raise(_Transition.ACTIVATE, {_ACTIVE})):
            return False
        self._active = True
        self.get_logger().info("Managed nodes are active")
        return True

    async def _pause(self) -> bool:
        self._active = False
        return await self._lower(_Transition.DEACTIVATE, _ACTIVE)

    async def _cleanup(self) -> bool:
        return await self._lower(_Transition.CLEANUP, _INACTIVE)

    async def _reset(self) -> bool:
        paused = await self._pause()
        return await self._cleanup() and paused

    async def _raise(self, transition: _Transition, done: set[int]) -> bool:
        """Trigger a transition of the nodes in order, except of those already in its goal state; stop at a failure."""
        for name in self._names:
            if await self._state_of(name) not in done and not await self._change(name, transition):
                self.get_logger().error(f"'{name}' did not {transition.name.lower()}; the others are not started")
                return False
        return True

    async def _lower(self, transition: _Transition, source: int) -> bool:
        """Trigger a transition of the nodes in a state in reverse order; stop at a failure."""
        for name in reversed(self._names):
            if await self._state_of(name) == source and not await self._change(name, transition):
                self.get_logger().error(f"'{name}' did not {transition.name.lower()}")
                return False
        return True

    # Requests to the nodes.

    async def _state_of(self, name: str) -> int:
        from lifecycle_msgs.srv import GetState

        client = await self._ready_client(GetState, name, "get_state")
        response = await client.call_async(GetState.Request())
        return int(response.current_state.id)

    async def _change(self, name: str, transition: _Transition) -> bool:
        from lifecycle_msgs.srv import ChangeState

        client = await self._ready_client(ChangeState, name, "change_state")
        request = ChangeState.Request()
        request.transition.id = int(transition)
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
        commands = {
            request.STARTUP: self._startup,
            request.PAUSE: self._pause,
            request.RESUME: self._startup,
            request.RESET: self._reset,
            request.SHUTDOWN: self._reset,
            request.CONFIGURE: self._configure,
            request.CLEANUP: self._cleanup,
        }
        if request.command in commands:
            response.success = await commands[request.command]()
        else:
            self.get_logger().error(f"there is no command {request.command}; they go from 0 to {max(commands)}")
        return response

    def _on_is_active(self, request: Any, response: Any) -> Any:
        response.success = self._active
        return response
