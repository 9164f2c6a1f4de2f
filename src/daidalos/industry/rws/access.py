"""Who may use the web services: digest authentication (RFC 7616, MD5) and basic authentication (RFC 7617)."""

from __future__ import annotations

import base64
import hashlib
import hmac
import re
import secrets
from collections import OrderedDict

USER, PASSWORD = "Default User", "robotics"
REALM = "validusers@robapi.abb"
COOKIE = "-http-session-"

_MAX_NONCES = 1000
_MAX_SESSIONS = 70
_PAIR = re.compile(r'(\w+)=(?:"((?:[^"\\]|\\.)*)"|([^\s,]+))')


class Access:
    """The check of one user's name and password; who has passed it has a session.

    Parameters
    ----------
    user, password : str
        Those of a controller as it is delivered, where they are left out.
    is_basic : bool
        Whether the password is sent as it is, as over an encrypted connection; otherwise as a digest.
    """

    def __init__(self, user: str = USER, password: str = PASSWORD, is_basic: bool = False) -> None:
        self._user, self._password, self.is_basic = user, password, is_basic
        self._nonces: OrderedDict[str, set[str]] = OrderedDict()
        self._sessions: OrderedDict[str, None] = OrderedDict()

    def challenge(self) -> str:
        """Return what the server answers to who has not said who he is."""
        if self.is_basic:
            return f'Basic realm="{REALM}"'
        nonce = secrets.token_hex(16)
        self._nonces[nonce] = set()
        while len(self._nonces) > _MAX_NONCES:
            self._nonces.popitem(last=False)
        return f'Digest realm="{REALM}", qop="auth", nonce="{nonce}", algorithm=MD5'

    def new_session(self) -> str:
        """Return the name of a new session."""
        name = secrets.token_hex(16)
        self._sessions[name] = None
        while len(self._sessions) > _MAX_SESSIONS:
            self._sessions.popitem(last=False)
        return name

    def has_session(self, name: str | None) -> bool:
        """Return whether there is a session of this name."""
        return name is not None and name in self._sessions

    def allows(self, header: str, method: str, uri: str) -> bool:
        """Return whether the header of a request shows that its sender knows the password."""
        scheme, _, rest = header.partition(" ")
        if self.is_basic:
            return scheme.lower() == "basic" and self._is_basic_right(rest)
        return scheme.lower() == "digest" and self._is_digest_right(rest, method, uri)

    def _is_basic_right(self, text: str) -> bool:
        try:
            given = base64.b64decode(text, validate=True)
        except ValueError:
            return False
        return hmac.compare_digest(given, f"{self._user}:{self._password}".encode())

    def _is_digest_right(self, text: str, method: str, uri: str) -> bool:
        given = {name: quoted or plain for name, quoted, plain in _PAIR.findall(text)}
        nonce, count = given.get("nonce", ""), given.get("nc", "")
        if nonce not in self._nonces or count in self._nonces[nonce] or given.get("uri") != uri:
            return False
        if given.get("username") != self._user or given.get("realm") != REALM or given.get("qop") != "auth":
            return False
        secret = _md5(f"{self._user}:{REALM}:{self._password}")
        asked = _md5(f"{method}:{uri}")
        right = _md5(f"{secret}:{nonce}:{count}:{given.get('cnonce', '')}:auth:{asked}")
        if not hmac.compare_digest(right.encode(), given.get("response", "").encode()):
            return False
        self._nonces[nonce].add(count)
        return True


def _md5(text: str) -> str:
    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()
