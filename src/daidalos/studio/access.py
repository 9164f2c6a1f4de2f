"""Access control: which hosts and origins may use the server.

A web page from anywhere may send requests to a server on loopback. Two headers identify it: ``Origin`` names the page,
and ``Host`` the name under which the server was looked up. With DNS rebinding both carry the
attacker's name, so a name is trusted only when it is known; a bare address cannot be rebound, and is a ``Host`` where
the server is exposed. The page's own origin must be that of the server, or one that was named.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Iterable
from urllib.parse import urlsplit

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})


class AccessPolicy:
    """Decides by the ``Host`` and ``Origin`` headers whether a request is served.

    Parameters
    ----------
    hosts
        Names or addresses, besides loopback, under which the server is known.
    origins
        Pages elsewhere that may connect, e.g. ``https://app.foxglove.dev``; ``*`` admits all.
    exposed
        Whether the server listens beyond loopback, so that it is reached by address.
    """

    def __init__(self, hosts: Iterable[str] = (), origins: Iterable[str] = (), *, exposed: bool = False) -> None:
        self._hosts = LOOPBACK_NAMES | {host.lower().strip("[]") for host in hosts}
        self._origins = frozenset(origin.rstrip("/").lower() for origin in origins)
        self._exposed = exposed

    def refusal_reason(self, host: str | None, origin: str | None) -> str | None:
        """Return why a request is refused, or None where it is allowed."""
        name = _host_name(f"//{host}") if host else None
        if name is None or not self._knows(name):
            return (
                f"Host {host or '(none)'!r} is not one that this server is known by; "
                "start it with this host allowed, or open it as localhost"
            )
        if origin is None or origin.lower().rstrip("/") in self._origins or "*" in self._origins:
            return None
        asker = _host_name(origin)
        if asker is None or not (asker == name or asker in self._hosts):
            return f"pages of {origin!r} may not use this server; start it with this origin allowed"
        return None

    def _knows(self, name: str) -> bool:
        return name in self._hosts or (self._exposed and _is_address(name))


def _host_name(url: str) -> str | None:
    try:
        return urlsplit(url).hostname
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
