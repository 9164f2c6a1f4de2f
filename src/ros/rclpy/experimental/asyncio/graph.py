"""The graph's changes, for coroutines."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from daidalos.transport.graph import EndpointInfo, Graph, NodeInfo
from rclpy.experimental.asyncio.loops import post


async def changes(graph: Graph) -> AsyncIterator[None]:
    """Yield at once, and then whenever the graph has changed."""
    loop, changed = asyncio.get_running_loop(), asyncio.Event()

    def on_change(added: bool, what: NodeInfo | EndpointInfo) -> None:
        post(loop, changed.set)

    stop = graph.listen(on_change)
    try:
        while True:
            yield
            await changed.wait()
            changed.clear()
    finally:
        stop()
