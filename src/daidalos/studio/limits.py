"""Limits of what one client, and all clients together, may take of the server."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Generator
from typing import TypeVar, cast

T = TypeVar("T")

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
MAX_READ_BYTES = 64 << 10
"""Bytes that are read from a connection at once."""
PIECE_BYTES = 8 << 10
"""Bytes of them that become messages before the client handles these."""
MAX_TEXT_BYTES = 4 << 20
"""Bytes of one text frame."""
MAX_ENTRIES = 2048
"""Entries of one list of a text frame."""
MAX_VALUES = 32 << 10
"""Values of one text frame."""
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
SLICE_S = 0.001
"""Time that a client's requests take before everything else has its turn."""
SLICE_REQUESTS = 32
"""Requests of a client, or entries of one, after which everything else has its turn."""


class Turn:
    """One client's turn in the server's event loop: clients handle their requests one after the other.

    However many of them have requests, the event loop does one request, or a part of it, between two looks at
    everything else, and a client that computes leaves as much time to everything else.

    Parameters
    ----------
    order
        Lock of all clients, whose waiters are served in the order in which they came.
    """

    def __init__(self, order: asyncio.Lock) -> None:
        self._order = order
        self._begin = 0.0
        self._used_s = 0.0
        self._requests = 0

    async def __aenter__(self) -> None:
        await self._order.acquire()
        self._begin = time.perf_counter()

    async def __aexit__(self, *error: object) -> None:
        try:
            await self.share()
        finally:
            self._order.release()

    async def share(self) -> None:
        """Rest after `SLICE_S` of work or `SLICE_REQUESTS`, for as long as the work took."""
        now = time.perf_counter()
        self._used_s += now - self._begin
        self._requests += 1
        self._begin = now
        if self._used_s >= SLICE_S or self._requests >= SLICE_REQUESTS:
            used, self._used_s, self._requests = self._used_s, 0.0, 0
            await asyncio.sleep(used)
            self._begin = time.perf_counter()

    async def share_steps(self, steps: Generator[None, None, T]) -> T:
        """Return the result of steps, with rests between them."""
        while True:
            try:
                next(steps)
            except StopIteration as end:
                return cast(T, end.value)
            await self.share()
