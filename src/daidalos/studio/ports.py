"""Opening the server's port: the same number on every address, the wanted one or the next that is free."""

from __future__ import annotations

import errno
import ipaddress
import socket
import sys
from collections.abc import Sequence

MAX_PORTS_TRIED = 64
BACKLOG = 128
"""Connections that wait in the system to be accepted."""
ACCEPTED_AT_ONCE = 1
"""Connections that are accepted before the event loop does something else."""
ANY_ADDRESS = frozenset({"0.0.0.0", "::", ""})
"""Addresses that stand for every address of this machine."""
_DOCUMENTATION_ADDRESS = ("192.0.2.1", 9)

_USED = {errno.EADDRINUSE, errno.EACCES}
_ABSENT = {errno.EADDRNOTAVAIL, errno.EAFNOSUPPORT}


class PortError(Exception):
    """No port could be opened; the text says which and why."""


class PortUsedError(PortError):
    """Every port that was tried is used."""


def open_port(hosts: Sequence[str], wanted: int, tried: int = MAX_PORTS_TRIED) -> list[socket.socket]:
    """Open a port on all of the hosts.

    Parameters
    ----------
    hosts
        Addresses or names; those of a family that this machine lacks (IPv6) are left out.
    wanted
        The first port to try; 0 leaves the choice to the system.
    tried
        How many ports to try.

    Returns
    -------
    list of socket
        Listening sockets, at least one, all of the same port.

    Raises
    ------
    PortError
        When a host is unknown, none can be listened on, or no port is free.
    """
    ports = range(wanted, min(wanted + tried, 1 << 16)) if wanted else [0] * MAX_PORTS_TRIED
    for port in ports:
        sockets = _open_on_all(hosts, port)
        if sockets is not None:
            return sockets
    if len(ports) == 1:
        raise PortUsedError(f"port {wanted} is used on {', '.join(hosts)}")
    raise PortUsedError(f"no free port from {wanted} to {wanted + len(ports) - 1} on {', '.join(hosts)}")


def is_loopback(host: str) -> bool:
    """Return whether an address or name is reached from this machine only."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def outward_address() -> str:
    """Return the address of this machine on the way to other machines, its name where it has none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_DOCUMENTATION_ADDRESS)  # looks for the way there, and sends nothing
            return str(probe.getsockname()[0])
        except OSError:
            return socket.gethostname()


def _open_on_all(hosts: Sequence[str], port: int) -> list[socket.socket] | None:
    """Return the sockets, or None where the port is used on one of the hosts."""
    sockets: list[socket.socket] = []
    reason = ""
    for host in hosts:
        try:
            sockets.append(_bind(host, port))
        except OSError as error:
            reason = f"cannot listen on {host}: {error.strerror or error}"
            if error.errno not in _ABSENT:
                for opened in sockets:
                    opened.close()
                if error.errno in _USED:
                    return None
                raise PortError(reason) from None
        else:
            port = sockets[0].getsockname()[1]
    if not sockets:
        raise PortError(reason or "no host to listen on")
    return sockets


def _bind(host: str, port: int) -> socket.socket:
    family, kind, number, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[
        0
    ]
    opened = socket.socket(family, kind, number)
    try:
        if sys.platform == "win32":
            # There, SO_REUSEADDR would take the port away from whoever has it.
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
        else:
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            opened.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        opened.bind(address)
        # At once: until somebody listens, two sockets may hold the same port.
        opened.listen(BACKLOG)
    except OSError:
        opened.close()
        raise
    opened.setblocking(False)
    return opened
