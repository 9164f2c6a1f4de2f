"""Registry of the live sessions on this machine, as files in the user's runtime folder.

A session holds a lock on its file for as long as its process lives, so the entries of processes that died, in
whatever way, are known from those that live. A session opens under the registry's lock: of two that start at
the same time, the later one finds the earlier one listening.
"""

from __future__ import annotations

import json
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from daidalos.common.file_locks import lock_file
from daidalos.transport.environment import EnvironmentVariableError

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
    return private_folder(folder)


def private_folder(path: Path) -> Path:
    """Return a folder after making sure that it is accessible only to the user; it is created if missing.

    Raises
    ------
    EnvironmentVariableError
        When it is a link, or belongs to another user, who could then read what nodes exchange.
    """
    try:
        path.mkdir(mode=0o700, exist_ok=True)
    except FileExistsError:
        raise _not_private(path, "is not a folder") from None
    found = path.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise _not_private(path, "is a link")
    if hasattr(os, "getuid"):
        if found.st_uid != os.getuid():
            raise _not_private(path, "belongs to another user")
        if found.st_mode & 0o077:
            path.chmod(0o700)
    return path


def _not_private(path: Path, fault: str) -> EnvironmentVariableError:
    return EnvironmentVariableError(
        f"the runtime folder '{path}' {fault}; remove it, or set XDG_RUNTIME_DIR to a folder of your own"
    )


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
        of_family = private_folder((runtime_folder() if folder is None else private_folder(folder)) / family)
        self.folder = private_folder(of_family / str(domain))
        self._entry: IO[bytes] | None = None
        self._data: Path | None = None

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Lock the registry against other readers and writers while the context lasts."""
        with open_private(self.folder / "registry.lock") as file:
            lock_file(file, wait=True)
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
        self._entry = open_private(self.folder / f"{peer.session}.alive")
        lock_file(self._entry, wait=False)
        self._data = self.folder / f"{peer.session}.json"
        with open_private(self._data) as file:
            file.write(json.dumps(peer.endpoints).encode())

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


def open_private(path: Path) -> IO[bytes]:
    """Open a file for appending; a new one is accessible only to the user."""
    return open(path, "ab", opener=lambda name, flags: os.open(name, flags, 0o600))


def _is_free(path: Path) -> bool:
    """Return whether no process holds the lock on a file."""
    with path.open("ab") as file:
        try:
            lock_file(file, wait=False)
        except OSError:
            return False
    return True
