"""Futures of a given event loop."""

from __future__ import annotations

import asyncio
from typing import Any


def create_future(loop: asyncio.AbstractEventLoop | None) -> asyncio.Future[Any]:
    """Return a new future of `loop`, or of the running loop where it is None."""
    return (loop or asyncio.get_running_loop()).create_future()
