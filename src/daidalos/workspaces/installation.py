"""Files installed below a prefix, removed when a later build no longer installs them."""

from __future__ import annotations

import shutil
from contextlib import suppress
from pathlib import Path

_EXECUTABLE = 0o755
_PLAIN = 0o644


class Installation:
    """Files of one package below a prefix.

    Parameters
    ----------
    prefix
        Where the files go.
    record
        A file that remembers from one build to the next which files there are.
    symlink
        Whether files are linked to where they come from, as far as the system allows.
    """

    def __init__(self, prefix: Path, record: Path, symlink: bool) -> None:
        self.prefix = prefix
        self._record = record
        self._symlink = symlink
        self._placed: dict[str, None] = {}

    def put(self, source: Path, destination: str, executable: bool = False) -> None:
        """Install a file; a file that lacks a required executable bit is copied instead of linked."""
        target = self._make_room(destination)
        source = source.resolve()
        if self._symlink and (not executable or source.stat().st_mode & 0o100):
            with suppress(OSError):  # such as on Windows without the right to link
                target.symlink_to(source)
                return
        shutil.copyfile(source, target)
        target.chmod(_EXECUTABLE if executable else _PLAIN)

    def write(self, destination: str, text: str, executable: bool = False) -> None:
        """Install a file with a text."""
        target = self._make_room(destination)
        target.write_text(text, encoding="utf-8", newline="\n")
        target.chmod(_EXECUTABLE if executable else _PLAIN)

    def register_installed(self, path: Path) -> None:
        """Record a file that was put below the prefix by other means as installed."""
        self._placed[path.relative_to(self.prefix).as_posix()] = None

    def finish(self) -> None:
        """Remove files that the last build installed and this one did not."""
        before = self._record.read_text(encoding="utf-8").splitlines() if self._record.is_file() else []
        for name in before:
            if name not in self._placed:
                path = self.prefix / name
                path.unlink(missing_ok=True)
                self._remove_empty(path.parent)
        self._record.parent.mkdir(parents=True, exist_ok=True)
        self._record.write_text("".join(f"{name}\n" for name in self._placed), encoding="utf-8")

    def _make_room(self, destination: str) -> Path:
        target = self.prefix / destination
        self._placed[destination] = None
        for parent in reversed(target.relative_to(self.prefix).parents):
            if (self.prefix / parent).is_symlink():
                (self.prefix / parent).unlink()
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.is_dir() and not target.is_symlink():
            shutil.rmtree(target)
        else:
            target.unlink(missing_ok=True)
        return target

    def _remove_empty(self, folder: Path) -> None:
        while folder != self.prefix and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
            folder = folder.parent
