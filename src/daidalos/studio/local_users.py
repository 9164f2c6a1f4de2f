"""Users of this machine behind connections over loopback, where the system lists them (Linux)."""

from __future__ import annotations

import ipaddress
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_TABLES = {4: Path("/proc/net/tcp"), 6: Path("/proc/net/tcp6")}
_ESTABLISHED = "01"
_ROOT = 0


def is_of_another_user(peer: Any, own: Any) -> bool:
    """Return whether a connection over loopback was made by a process of another user than this process's, or root.

    A connection that its owner has closed belongs to nobody, and counts as another user's. Where the system has no
    list of connections, none does.

    Parameters
    ----------
    peer, own
        The connection's two ends, as ``getpeername`` and ``getsockname`` return them.
    """
    if not sys.platform.startswith("linux"):
        return False
    try:
        address = ipaddress.ip_address(peer[0])
        if not address.is_loopback:
            return False
        lines = _TABLES[address.version].read_text(encoding="ascii").splitlines()[1:]
    except (OSError, ValueError):
        return False
    users = set(_users(lines, _entry(peer), _entry(own)))
    return not users & {os.getuid(), _ROOT}


def _users(lines: list[str], local: str, remote: str) -> Iterator[int]:
    for line in lines:
        fields = line.split()
        if fields[1:4] == [local, remote, _ESTABLISHED]:
            yield int(fields[7])


def _entry(end: Any) -> str:
    """Return an address and port as the kernel writes them: groups of four bytes in the machine's order."""
    packed = ipaddress.ip_address(end[0]).packed
    groups = (int.from_bytes(packed[at : at + 4], sys.byteorder) for at in range(0, len(packed), 4))
    return "".join(f"{group:08X}" for group in groups) + f":{end[1]:04X}"
