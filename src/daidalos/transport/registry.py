"""Registry of the live sessions on this machine, as files in the user's runtime folder.

A session holds a lock on its file for as long as its process lives, so the entries of processes that died, in
whatever way, are known from those that live. A session opens under the registry's lock: of two that start at
the same time, the later one finds the earlier one listening.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

_SOCKET_NAME_LENGTH = 16


@dataclass(frozen=True)
class Peer:
    """Live session: its zenoh id and its listening address."""

    session: str
    endpoints: tuple[str, ...]


def runtime_folder() -> Path:
    """Return the folder for files of running processes, created if missing and accessible only to the user."""
    base = os.environ.get("XDG_RUNTIME_DIR")
    if base and os.access(base, os.W_OK):
        folder = Path(base) / "daidalos"
    else:
        user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
        folder = Path(tempfile.gettempdir()) / f"daidalos-{user}"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return folder


class Registry:
    """Live sessions of one domain.

    Parameters
    ----------
    domain
        Its number.
    folder
        Where the registry is kept; the user's runtime folder where None.
    family
        Whose sessions: each middleware has its own.
    """

    def __init__(self, domain: int, folder: Path | None = None, family: str = "zenoh") -> None:
        self.folder = (folder or runtime_folder()) / family / str(domain)
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._entry: IO[bytes] | None = None
        self._data: Path | None = None

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Lock the registry against other readers and writers while the context lasts."""
        with (self.folder / "registry.lock").open("ab") as file:
            _lock(file, wait=True)
            yield

    def peers(self) -> list[Peer]:
        """Return the other live sessions and remove files of dead ones; call while `locked`."""
        found = []
        for lock in sorted(self.folder.glob("*.alive")):
            data = lock.with_suffix(".json")
            if self._data == data:
                continue
            try:
                if _is_free(lock):
                    data.unlink(missing_ok=True)
                    lock.unlink(missing_ok=True)
                    self.remove_socket(lock.stem)
                    continue
                found.append(Peer(lock.stem, tuple(json.loads(data.read_text(encoding="utf-8")))))
            except (OSError, ValueError):
                continue  # it went away, or is not yet written, while we looked
        return found

    def socket_of(self, session: str) -> Path:
        """Return the path of a session's socket, short because socket paths are limited."""
        return self.folder / f"{session[:_SOCKET_NAME_LENGTH]}.sock"

    def remove_socket(self, session: str) -> None:
        """Remove a session's socket with the lock that zenoh puts beside it."""
        path = self.socket_of(session)
        for leftover in (path, path.with_suffix(".sock.lock")):
            leftover.unlink(missing_ok=True)

    def register(self, peer: Peer) -> None:
        """Register this session until this process ends or `unregister` is called."""
        self._entry = (self.folder / f"{peer.session}.alive").open("ab")
        _lock(self._entry, wait=False)
        self._data = self.folder / f"{peer.session}.json"
        self._data.write_text(json.dumps(peer.endpoints), encoding="utf-8")

    def unregister(self) -> None:
        """Remove the entry of this session."""
        entry, data, self._entry, self._data = self._entry, self._data, None, None
        if entry is None or data is None:
            return
        data.unlink(missing_ok=True)
        if sys.platform == "win32":
            entry.close()
        data.with_suffix(".alive").unlink(missing_ok=True)
        entry.close()


def _is_free(path: Path) -> bool:
    """Return whether no process holds the lock on a file."""
    with path.open("ab") as file:
        try:
            _lock(file, wait=False)
        except OSError:
            return False
    return True


def _lock(file: IO[bytes], *, wait: bool) -> None:
    """Lock a file until it is closed; without `wait`, raise OSError if another process holds the lock."""
    if sys.platform == "win32":
        import msvcrt

        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
