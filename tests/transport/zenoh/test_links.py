"""TCP links that do not hold up others when they close."""

from __future__ import annotations

import json
import os
import socket
import struct
import sys
import time
from contextlib import suppress

import psutil
import pytest
import zenoh

from daidalos.transport.zenoh.links import clear_linger, disable_linger

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="sockets cannot be listed there")


def lingering(link: socket.socket) -> tuple[int, ...]:
    return struct.unpack("ii", link.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8))


def lingering_of_links() -> list[tuple[int, ...]]:
    """Return the lingering of each TCP connection of this process."""
    found = []
    for connection in psutil.Process().net_connections("tcp"):
        if connection.raddr:
            with suppress(OSError), socket.socket(fileno=os.dup(connection.fd)) as link:  # closed by now
                found.append(lingering(link))
    return found


def opened(**endpoints: str) -> zenoh.Session:
    """Open a session that has no links but those named."""
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    for how in ("listen", "connect"):
        config.insert_json5(f"{how}/endpoints", json.dumps([endpoints[how]] if how in endpoints else []))
    return zenoh.open(config)


def test_links_of_a_session_close_at_once():
    with socket.create_server(("127.0.0.1", 0)) as probe:
        endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
    with opened(listen=endpoint) as first:
        kept = disable_linger(first)
        with opened(connect=endpoint):
            deadline = time.monotonic() + 30
            while len(links := lingering_of_links()) < 2 or (1, 10) in links:
                assert time.monotonic() < deadline, links
        kept.undeclare()


def test_only_zenohs_lingering_is_taken_and_nothing_is_left_open():
    with socket.create_server(("127.0.0.1", 0)) as server, socket.create_connection(server.getsockname()) as link:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 5))
        link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 10))
        before = os.listdir("/dev/fd")
        clear_linger()
        assert os.listdir("/dev/fd") == before
        assert lingering(server) == (1, 5)
        assert lingering(link)[0] == 0
