"""Clients of services, for asyncio."""

from __future__ import annotations

import asyncio
from typing import Any

from rclpy.client import Client
from rclpy.experimental.asyncio.graph import changes
from rclpy.experimental.asyncio.loops import post
from rclpy.task import Future


class AsyncClient(Client):
    """Client of a service; made by `AsyncNode.create_client`."""

    _calls: set[asyncio.Future[Any]]

    async def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Call the service, and return the response.

        Raises
        ------
        TimeoutError
            When `timeout_sec` seconds (None: no limit) pass without one.
        TypeError
            When the request is of the wrong type.
        RuntimeError
            After `destroy`.
        asyncio.CancelledError
            When the client is destroyed meanwhile.
        """
        if self.handle.is_destroyed:
            raise RuntimeError(f"the client of '{self.srv_name}' was destroyed")
        loop = asyncio.get_running_loop()
        answer: asyncio.Future[Any] = loop.create_future()
        future = self.call_async(request)
        future.on_wake(lambda: post(loop, _forward_message, future, answer))
        self._calls = {*getattr(self, "_calls", ()), answer}
        try:
            async with asyncio.timeout(timeout_sec):
                return await answer
        finally:
            self._calls.discard(answer)
            self.remove_pending_request(future)

    async def wait_for_service(  # type: ignore[override]  # awaited, unlike that of `Client`
        self, timeout_sec: float | None = None
    ) -> bool:
        """Wait until somebody serves the service; False when `timeout_sec` seconds pass."""
        try:
            async with asyncio.timeout(timeout_sec):
                async for _ in changes(self.handle.node.graph):
                    if self.service_is_ready():
                        break
        except TimeoutError:
            if timeout_sec is None:
                raise
            return False
        return True

    def destroy(self) -> None:
        """Destroy the handle; calls that wait for a response are cancelled."""
        super().destroy()
        for answer in getattr(self, "_calls", ()):
            answer.cancel()


def _forward_message(future: Future, answer: asyncio.Future[Any]) -> None:
    if future.done() and not answer.done():
        answer.set_result(future.result())
