"""Access control: who may use the server, for the page, its assets and every protocol alike.

A web page from anywhere may send requests to a server on loopback. Two headers identify it: ``Origin`` names the page,
and ``Host`` the name under which the server was looked up. With DNS rebinding both carry the attacker's name, so that a
name is trusted only when it is known. The page's origin must be that of the server, or one that was named.

A server that can be reached from other machines also asks for a token, which is part of the address that it prints. A
browser gets it as a cookie at its first visit; other clients send it in the address or in a header each time. Who knows
the token may use any name and any origin; a browser that sends the cookie, for whichever page, must name an origin.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from urllib.parse import urlsplit

from aiohttp import web

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
TOKEN_QUERY = "token"
_FORBIDDEN, _UNAUTHORIZED, _TOO_LONG = 403, 401, 414
_DEFAULT_PORTS = {"http": 80, "https": 443, "ws": 80, "wss": 443}
MAX_TARGET_LENGTH = 4096
"""Characters of the path and the query of a request."""


@dataclass(frozen=True)
class Request:
    """What identifies the sender of a request.

    Attributes
    ----------
    host, origin
        The headers of these names.
    token
        The token in the address or in a header; None where there is none.
    cookie
        The token in the cookie.
    """

    host: str | None = None
    origin: str | None = None
    token: str | None = None
    cookie: str | None = None


@dataclass(frozen=True)
class Refusal:
    """Why a request is refused, as an HTTP status and a text."""

    status: int
    reason: str


class AccessPolicy:
    """Decides whether a request is served.

    Parameters
    ----------
    hosts
        Names or addresses, besides loopback, under which the server is known; of no effect with a token.
    origins
        Pages elsewhere that may connect, e.g. ``https://app.foxglove.dev``; ``*`` admits all.
    token
        The secret that requests must bring; None asks for none.
    """

    def __init__(self, hosts: Iterable[str] = (), origins: Iterable[str] = (), token: str | None = None) -> None:
        self._hosts = LOOPBACK_NAMES | {host.lower().strip("[]") for host in hosts}
        self._origins = frozenset(origin.rstrip("/").lower() for origin in origins)
        self._token = token

    def refusal(self, request: Request) -> Refusal | None:
        """Return why a request is refused, or None where it is allowed."""
        if self._token is not None:
            if _equal(request.token, self._token):
                return None
            if not _equal(request.cookie, self._token):
                return Refusal(
                    _UNAUTHORIZED,
                    "this server asks for the token that is part of the address it printed at its start: "
                    "?token=... or the header 'Authorization: Bearer ...'",
                )
        elif not self._is_known(request.host):
            return Refusal(
                _FORBIDDEN,
                f"Host {request.host or '(none)'!r} is not one that this server is known by; "
                "start it with this host allowed, or open it as localhost",
            )
        if not self._is_own_or_named(request.origin, request.host):
            return Refusal(
                _FORBIDDEN,
                f"pages of {request.origin!r} may not use this server; start it with this origin allowed",
            )
        return None

    def _is_known(self, host: str | None) -> bool:
        return _name_and_port(f"//{host}", None)[0] in self._hosts if host else False

    def _is_own_or_named(self, origin: str | None, host: str | None) -> bool:
        if origin is None or "*" in self._origins or origin.lower().rstrip("/") in self._origins:
            return True
        # The scheme may differ: a proxy in front of the server may add encryption.
        default = _DEFAULT_PORTS.get(origin.partition(":")[0].lower())
        asker = _name_and_port(origin, default)
        return asker[0] is not None and asker == _name_and_port(f"//{host}", default)


def new_token() -> str:
    """Return a random token."""
    return secrets.token_urlsafe(24)


def cookie_name(port: int) -> str:
    """Return the name of the cookie that holds the token; browsers send cookies to every port of a host."""
    return f"daidalos_token_{port}"


def identify(request: web.Request, port: int) -> Request:
    """Return what identifies the sender of an HTTP request to a server's port."""
    scheme, _, credentials = request.headers.get("Authorization", "").partition(" ")
    token = credentials.strip() if scheme.lower() == "bearer" else None
    return Request(
        request.headers.get("Host"),
        request.headers.get("Origin"),
        request.query.get(TOKEN_QUERY) or token,
        request.cookies.get(cookie_name(port)),
    )


def too_long(request: web.Request) -> Refusal | None:
    """Return the refusal of a request whose address is too long to name anything here."""
    if len(request.raw_path) <= MAX_TARGET_LENGTH:
        return None
    return Refusal(_TOO_LONG, f"the address has more than {MAX_TARGET_LENGTH} characters")


def entrance(request: web.Request, port: int, token: str) -> web.Response | None:
    """Return the response that moves the token of a browser's first visit from the address into a cookie.

    None where the address of the request has no token, or the client is no browser that shows a page. A browser whose
    cookie admitted it keeps that, where the address has another token.
    """
    wants_page = "text/html" in request.headers.get("Accept", "")
    if not wants_page or TOKEN_QUERY not in request.query:
        return None
    query = {name: value for name, value in request.query.items() if name != TOKEN_QUERY}
    response = web.Response(status=303, headers={"Location": str(request.rel_url.with_query(query))})
    response.headers["Cache-Control"] = "no-store"
    if _equal(request.query[TOKEN_QUERY], token):
        response.set_cookie(cookie_name(port), token, httponly=True, samesite="Strict", secure=request.secure)
    return response


def _equal(given: str | None, token: str) -> bool:
    return given is not None and hmac.compare_digest(given.encode("utf-8", "replace"), token.encode())


def _name_and_port(url: str, default: int | None) -> tuple[str | None, int | None]:
    try:
        parts = urlsplit(url)
        return parts.hostname, parts.port or default
    except ValueError:
        return None, None
