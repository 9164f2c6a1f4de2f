"""Reserves ROS domains: who holds the port that stands for a domain has the domain."""

from __future__ import annotations

import random
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_DOMAINS = 100
# Below the ports that systems give to whoever asks for any.
PORT_BASE = 20300
_FIRST = random.randrange(_DOMAINS)


class default_selector:
    """Selector that proposes all domains from 1 to 100, from one on that is random, and the same in a process."""

    def __init__(self) -> None:
        self._next = _FIRST

    def __call__(self) -> int:
        """Return the next domain to try."""
        self._next = self._next % _DOMAINS + 1
        return self._next


@contextmanager
def domain_id(selector: Callable[[], int] | None = None) -> Iterator[int]:
    """Reserve a ROS domain from 1 to 100 for the ``with`` block; no other process gets it meanwhile.

    Parameters
    ----------
    selector
        Returns the domain to try next.

    Raises
    ------
    RuntimeError
        When a hundred tries found no domain that is free.
    """
    select = selector or default_selector()
    for _ in range(_DOMAINS):
        domain = select()
        holder = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        with holder:
            if _bind(holder, PORT_BASE + domain):
                yield domain
                return
    raise RuntimeError(f"none of the ROS domains from 1 to {_DOMAINS} is free: other tests hold them")


def _bind(holder: socket.socket, port: int) -> bool:
    if sys.platform == "win32":
        # There, two may bind one port unless one says otherwise.
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
    try:
        holder.bind(("127.0.0.1", port))
    except OSError:
        return False
    return True
