"""Users of this machine behind connections over loopback, where the system lists them (Linux)."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_TABLES = {4: Path("/proc/net/tcp"), 6: Path("/proc/net/tcp6")}
_ESTABLISHED = "01"
_ROOT = 0
# Of linux/netlink.h, linux/sock_diag.h and linux/inet_diag.h.
_NETLINK_SOCK_DIAG, _SOCK_DIAG_BY_FAMILY, _NLM_F_REQUEST, _NLMSG_ERROR = 4, 20, 1, 2
_HEADER = struct.Struct("=IHHII")
_REQUEST = struct.Struct("=BBHI")
_SOCKET = struct.Struct(">HH16s16s")
_USER_OFFSET = 64
"""Bytes before the user in ``inet_diag_msg``."""
_TIMEOUT_S = 0.1


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
        users = _ask_kernel(address.version, peer, own)
        if users is None:
            users = set(_users(_lines(address.version), _entry(peer), _entry(own)))
    except (OSError, ValueError):
        return False
    return not users & {os.getuid(), _ROOT}


def _lines(version: int) -> list[str]:
    return _TABLES[version].read_text(encoding="ascii").splitlines()[1:]


def _ask_kernel(version: int, local: Any, remote: Any) -> set[int] | None:
    """Return the user of one connection's local end, nobody of one that was closed; None where the kernel is silent.

    Reading the list of all connections instead takes milliseconds where there are thousands of them.
    """
    family = socket.AF_INET if version == 4 else socket.AF_INET6
    places = (ipaddress.ip_address(end[0]).packed.ljust(16, b"\0") for end in (local, remote))
    body = _REQUEST.pack(family, socket.IPPROTO_TCP, 0, 0xFFFFFFFF) + _SOCKET.pack(local[1], remote[1], *places)
    body += struct.pack("=III", 0, 0xFFFFFFFF, 0xFFFFFFFF)
    try:
        with socket.socket(socket.AF_NETLINK, socket.SOCK_DGRAM, _NETLINK_SOCK_DIAG) as kernel:
            kernel.settimeout(_TIMEOUT_S)
            kernel.send(_HEADER.pack(_HEADER.size + len(body), _SOCK_DIAG_BY_FAMILY, _NLM_F_REQUEST, 0, 0) + body)
            answer = kernel.recv(4096)
    except OSError:
        return None
    kind = _HEADER.unpack_from(answer)[1] if len(answer) >= _HEADER.size else 0
    if kind == _NLMSG_ERROR and len(answer) >= _HEADER.size + 4:
        return set() if struct.unpack_from("=i", answer, _HEADER.size)[0] == -errno.ENOENT else None
    if kind != _SOCK_DIAG_BY_FAMILY or len(answer) < _HEADER.size + _USER_OFFSET + 4:
        return None
    if answer[_HEADER.size + 1] != int(_ESTABLISHED):
        return set()
    return {int(struct.unpack_from("=I", answer, _HEADER.size + _USER_OFFSET)[0])}


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
