"""Temporary files and folders that are deleted when this process ends."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from pathlib import Path

_paths: set[Path] = set()
_owner = 0


def write_temporary(text: str, prefix: str, suffix: str = "") -> Path:
    """Write a text to a file that lasts as long as this process.

    Parameters
    ----------
    text
        Written as UTF-8.
    prefix, suffix
        Beginning and end of the file's name.
    """
    with tempfile.NamedTemporaryFile("w", prefix=prefix, suffix=suffix, delete=False, encoding="utf-8") as file:
        file.write(text)
    return _registered(Path(file.name))


def make_temporary_folder(prefix: str) -> Path:
    """Make a folder that lasts as long as this process."""
    return _registered(Path(tempfile.mkdtemp(prefix=prefix)))


def delete_temporary_files() -> None:
    """Delete what this process has made; the interpreter calls it at exit, and whoever ends by `os._exit` before it."""
    if _owner != os.getpid():
        return  # a fork does not delete what its parent uses
    while _paths:
        path = _paths.pop()
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def _registered(path: Path) -> Path:
    global _owner
    if _owner != os.getpid():
        _paths.clear()
        _owner = os.getpid()
        atexit.register(delete_temporary_files)
    _paths.add(path)
    return path
