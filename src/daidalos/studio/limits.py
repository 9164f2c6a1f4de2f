"""Limits of what one client, and all clients together, may take of the server."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator

MAX_CONNECTIONS = 256
"""Connections that are open at once; of these that have not sent a request, the oldest makes room for a new one."""
HANDSHAKE_S = 10.0
"""Time in which a request must be complete."""
MESSAGE_S = 60.0
"""Time in which a message that has begun must be complete."""
STALL_S = 30.0
"""Time after which a client that reads nothing of what waits for it is closed."""
SWEEP_PERIOD_S = 0.5
"""Period in which connections are checked."""
MAX_UNFINISHED_BYTES = 48 << 20
"""Bytes of incomplete messages of several clients; beyond, the one that began first is closed."""
MAX_HELD_BYTES = 48 << 20
"""Bytes that wait to be sent, of all clients; beyond, the ones that read nothing for longest are closed."""
MAX_TEXT_BYTES = 4 << 20
"""Bytes of one text frame."""
MAX_ENTRIES = 2048
"""Entries of one list of a text frame."""
MAX_PUBLICATIONS = 256
"""Channels that one client advertises."""
MAX_WATCHED = 4096
"""Parameters that one client watches by name."""
MAX_PENDING_REQUESTS = 256
"""Service calls, parameter requests and assets of one client that have no answer yet."""
MAX_ERRORS = 8
"""Errors that are told for one frame."""
MAX_ERROR_LENGTH = 500
"""Characters of an error's text, which may repeat what a client sent."""
MAX_REASON_BYTES = 120
"""Bytes of the reason for which a connection is closed (RFC 6455, 5.5)."""
HEAVY_BYTES = 2 << 10
"""Bytes of a text frame that takes long to read."""
SLICE_S = 0.001
"""Time that one client's requests take before other clients have their turn."""


class Turns:
    """Turns of the clients in the server's event loop, so that busy ones take at most half of its time."""

    def __init__(self) -> None:
        self._busy = 0
        self._heavy = asyncio.Lock()

    @contextlib.asynccontextmanager
    async def heavy(self, size: int) -> AsyncIterator[None]:
        """Handle a frame of `size` bytes: large ones one after the other, with as much time for others between."""
        if size < HEAVY_BYTES:
            yield
            return
        async with self._heavy:
            begin = time.perf_counter()
            yield
            await asyncio.sleep(time.perf_counter() - begin)

    async def give(self, used_s: float) -> None:
        """Wait until others had their turn, after `used_s` seconds of work."""
        self._busy += 1
        try:
            await asyncio.sleep(2 * used_s * (self._busy - 1))
        finally:
            self._busy -= 1


class Turn:
    """One client's share of the event loop."""

    def __init__(self, turns: Turns) -> None:
        self._turns = turns
        self._begin = time.perf_counter()

    def resume(self) -> None:
        """Count from now: the client had nothing to do."""
        self._begin = time.perf_counter()

    async def share(self) -> None:
        """Hand on to others where this one has lasted `SLICE_S`."""
        used = time.perf_counter() - self._begin
        if used >= SLICE_S:
            await self._turns.give(used)
            self._begin = time.perf_counter()
