"""`lifecycle_manager`: starts managed nodes in order, stops them in reverse, and acts when one of them goes down."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.nav2_lifecycle_manager._server_watch import WATCH_PERIOD_S, ServerWatch, stop_robot
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
    bond_timeout: float = parameter(
        4.0, "Time without an answer after which a node is down; 0 for no watch over the nodes.", unit="s", minimum=0.0
    )
    attempt_respawn_reconnection: bool = parameter(
        True, "Whether the nodes are brought up again when the one that was down is back."
    )
    bond_respawn_max_duration: float = parameter(
        10.0, "How long a node that is down is waited for.", unit="s", minimum=0.0
    )


class LifecycleManager(Node):
    """Manages the nodes in its parameter ``node_names``; with ``autostart`` it begins by itself.

    A node that is not there yet is waited for, however long it takes: no order of starting and no slow
    machine makes the bring-up fail. When an active node ends, or does not answer for ``bond_timeout``, the robot is
    stopped by a velocity of zero on ``cmd_vel``, the others are deactivated, and all are brought up again when it is
    back.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("lifecycle_manager", **kwargs)
        from nav2_msgs.srv import ManageLifecycleNodes
        from std_srvs.srv import Trigger

        self._settings = parameters = declare(self, LifecycleManagerParameters)
        self._names = [name for name in parameters.node_names if name]
        self._clients: dict[tuple[str, str], Any] = {}
        self._active = False
        self._group = MutuallyExclusiveCallbackGroup()
        own = MutuallyExclusiveCallbackGroup()
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self._on_manage, callback_group=own)
        self.create_service(Trigger, "~/is_active", self._on_is_active)
        if parameters.bond_timeout > 0.0:
            self._watch = ServerWatch(self, parameters.bond_timeout, self._client)
            self._watch_timer = self.create_timer(
                WATCH_PERIOD_S,
                self._look_after_nodes,
                callback_group=own,
                clock=self._watch.clock,
            )
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

    async def _look_after_nodes(self) -> None:
        """Stop the robot and the other nodes when a node is down, and bring them up when it is back."""
        name, problem = self._watch.problem(self._names) if self._active else ("", "")
        if not name:
            return
        self._active = False
        self.get_logger().fatal(f"'{name}' is down: {problem}; stopping the robot and the other nodes")
        stop_robot(self)
        await self._lower(_Transition.DEACTIVATE, _ACTIVE, without=name)
        stop_robot(self)
        p = self._settings
        if not p.attempt_respawn_reconnection:
            return
        if await self._watch.all_return(self._names, p.bond_respawn_max_duration):
            self.get_logger().info("all nodes are there again")
            await self._startup()
        else:
            missing = ", ".join(self._watch.missing(self._names))
            self.get_logger().error(
                f"not back within {p.bond_respawn_max_duration:g} s: {missing}; start it and call ~/manage_nodes"
            )

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

    async def _lower(self, transition: _Transition, source: int, without: str = "") -> bool:
        """Trigger a transition of the nodes in a state in reverse order, one perhaps left out; stop at a failure."""
        from lifecycle_msgs.srv import GetState

        for name in reversed(self._names):
            if name == without or not self._client(GetState, name, "get_state").service_is_ready():
                continue  # it is down
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

    def _client(self, kind: Any, node: str, service: str) -> Any:
        key = (node, service)
        if key not in self._clients:
            name = f"{node}/{service}"
            self._clients[key] = self.create_client(kind, name, callback_group=self._group)
        return self._clients[key]

    async def _ready_client(self, kind: Any, node: str, service: str) -> Any:
        client = self._client(kind, node, service)
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
