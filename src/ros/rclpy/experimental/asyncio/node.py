"""Nodes for asyncio."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

from rclpy.client import Client
from rclpy.clock import Clock
from rclpy.constants import S_TO_NS
from rclpy.experimental.asyncio.client import AsyncClient
from rclpy.experimental.asyncio.clock import AsyncClock
from rclpy.experimental.asyncio.dispatcher import Dispatcher
from rclpy.experimental.asyncio.graph import changes
from rclpy.experimental.asyncio.loops import post
from rclpy.experimental.asyncio.publisher import AsyncPublisher
from rclpy.experimental.asyncio.timer import AsyncTimer
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription


class AsyncNode(Node):
    """A node whose callbacks, functions or coroutine functions, run in the event loop that enters or runs it.

    ``async with AsyncNode("name") as node`` runs it for a block and destroys it at its end; ``await node.run()`` runs
    it until somebody destroys it. An exception of a callback ends either, as an ``ExceptionGroup``. The parameters
    are those of `Node`.
    """

    _clock: AsyncClock
    _rcl_client_class = AsyncClient
    _rcl_clock_class = AsyncClock

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        self._group: asyncio.TaskGroup | None = None
        self._dispatcher: Dispatcher | None = None
        self._stopped = asyncio.Event()
        super().__init__(node_name, **kwargs)

    async def __aenter__(self) -> Self:
        await self._begin()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._group is not None
        self.destroy_node()
        await self._group.__aexit__(kind, error, trace)

    async def run(self) -> None:
        """Run the node until it is destroyed, or its context is shut down.

        Raises
        ------
        RuntimeError
            When it runs already, or was destroyed.
        ExceptionGroup
            With the exceptions of callbacks.
        """
        await self._begin()
        assert self._group is not None
        try:
            await self._stopped.wait()
        except BaseException as error:
            self.destroy_node()
            await self._group.__aexit__(type(error), error, error.__traceback__)
            raise
        self.destroy_node()
        await self._group.__aexit__(None, None, None)

    async def _begin(self) -> None:
        self._check_alive()
        if self._dispatcher is not None:
            raise RuntimeError(f"node '{self.get_name()}' runs already")
        self._loop = asyncio.get_running_loop()
        self._group = asyncio.TaskGroup()
        await self._group.__aenter__()
        self._dispatcher = Dispatcher(self._loop, self._group)
        self._rcl_attach_executor(self._dispatcher)  # type: ignore[arg-type]
        self.context.on_shutdown(self._on_shutdown)

    def _on_shutdown(self) -> None:
        post(self._loop, self._stopped.set)

    def _check_alive(self) -> None:
        if self.handle.is_destroyed:
            raise RuntimeError("the node was destroyed")

    def destroy_node(self) -> None:
        """Destroy the node, and cancel running callbacks, sleepers and callers. Further calls do nothing."""
        if self.handle.is_destroyed:
            return
        self._stopped.set()
        if self._dispatcher is not None:
            self._dispatcher.close()
        self._clock.close()
        super().destroy_node()

    def create_publisher(self, msg_type: Any, topic: str, qos_profile: QoSProfile | int, **kwargs: Any) -> Publisher:
        """Publish on a topic; see `Node.create_publisher`. RuntimeError after `destroy_node`."""
        self._check_alive()
        kwargs.setdefault("publisher_class", AsyncPublisher)
        return super().create_publisher(msg_type, topic, qos_profile, **kwargs)

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        concurrent: bool = False,
        **kwargs: Any,
    ) -> Subscription:
        """Receive a topic's messages; see `Node.create_subscription`.

        With `concurrent`, a message's callback does not wait for the end of those before it.
        """
        self._check_alive()
        subscription = super().create_subscription(msg_type, topic, callback, qos_profile, **kwargs)
        subscription.concurrent = concurrent
        return subscription

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        concurrent: bool = False,
        **kwargs: Any,
    ) -> Service:
        """Serve a service; see `Node.create_service`, and `create_subscription` for `concurrent`."""
        self._check_alive()
        service = super().create_service(srv_type, srv_name, callback, **kwargs)
        service.concurrent = concurrent
        return service

    def create_client(self, srv_type: Any, srv_name: str, **kwargs: Any) -> Client:
        """Call a service; see `Node.create_client`."""
        self._check_alive()
        return super().create_client(srv_type, srv_name, **kwargs)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: Any = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> AsyncTimer:
        """Call a function every `timer_period_sec` seconds of a clock, by default the node's."""
        self._check_alive()
        timer = AsyncTimer(
            callback,
            self.default_callback_group,
            int(timer_period_sec * S_TO_NS),
            clock or self._clock,
            context=self.context,
            autostart=autostart,
        )
        self._rcl_add("timer", timer)
        return timer

    async def wait_for_node(  # type: ignore[override]  # awaited, unlike that of `Node`
        self, fully_qualified_node_name: str, timeout: float | None = None
    ) -> bool:
        """Wait until a node is there; False when `timeout` seconds (None: no limit) pass first."""
        name = f"/{fully_qualified_node_name.lstrip('/')}"
        graph = self.handle.graph
        try:
            async with asyncio.timeout(timeout):
                async for _ in changes(graph):
                    if any(node.full_name == name for node in graph.nodes()):
                        break
        except TimeoutError:
            if timeout is None:
                raise
            return False
        return True
