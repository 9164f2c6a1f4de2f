"""Immediate closing of zenoh's TCP links.

Zenoh asks the system to linger for ten seconds over what was not sent when a link closes. The other end of a link that
is given up is usually gone, so that ten seconds it takes, on one of the few threads that serve all links: meanwhile
nothing is read from those that are well, and their other ends give them up in turn. Without lingering the system sends
what is left in its own time.
"""

from __future__ import annotations

import os
import socket
import stat
import struct
import sys
import threading
from contextlib import suppress
from typing import Any

import zenoh
from zenoh.handlers import FifoChannel

_MANY_LINKS = 100_000
"""More links than ever wait to be looked at; a full channel would hold zenoh up."""

_ZENOH_LINGER = struct.pack("ii", 1, 10)
_NONE = struct.pack("ii", 0, 0)


def disable_linger(session: Any) -> Any:
    """Disable lingering of every TCP link of a session, now and for new links.

    Returns what must be kept as long as the session; a thread of its own does the work, as zenoh's must never wait
    for Python's lock.
    """
    listener = session.info.declare_link_events_listener(FifoChannel(_MANY_LINKS), history=True)
    threading.Thread(target=_follow, args=(listener.handler,), name="links", daemon=True).start()
    return listener


def _follow(events: Any) -> None:
    for event in events:
        if event.kind == zenoh.SampleKind.PUT and event.link.is_streamed:
            clear_linger()


def clear_linger() -> None:
    """Disable lingering of the sockets of this process with zenoh's setting."""
    if sys.platform == "win32":
        return  # sockets cannot be listed there
    for number in map(int, os.listdir("/dev/fd")):
        with suppress(OSError):  # it is closed by now, or of a kind that cannot linger
            if stat.S_ISSOCK(os.fstat(number).st_mode):
                with socket.socket(fileno=os.dup(number)) as link:
                    _stop(link)


def _stop(link: socket.socket) -> None:
    if link.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, len(_ZENOH_LINGER)) == _ZENOH_LINGER:
        link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _NONE)
