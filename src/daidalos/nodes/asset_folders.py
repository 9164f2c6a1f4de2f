"""Folders whose meshes and textures the studio serves: those of the environment, and of files on command lines.

A program that is given a description on its command line records the folder of that file in the user's runtime folder,
which no other user can write; a studio of the same user, whichever process it runs in, reads the records there. What
arrives over the graph or from a page is never recorded.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

_DESCRIPTIONS = (".urdf", ".xacro", ".sdf", ".world", ".model", ".dae", ".stl", ".obj", ".glb", ".gltf")
_LAUNCH_FILES = (".launch", "launch.py", "launch.xml", "launch.yaml", "launch.yml")
_MANIFESTS = ("package.xml", "model.config")
_MAX_LEVELS_UP = 3
"""How far above a file its package or model may begin: ``urdf/arms/arm.xacro`` of a package is two levels down."""
_LIFETIME_S = 24 * 3600.0
"""How long the record of a program that has ended is kept: what it spawned is still shown."""

_held: list[IO[bytes]] = []
"""Records of this process, locked until it ends."""


@dataclass(frozen=True)
class AssetFolder:
    """Folder of a file that the user named.

    Attributes
    ----------
    path
        Without links.
    recursive
        Whether the folders within belong to it. Those of a home folder and of the temporary folder do not.
    """

    path: Path
    recursive: bool

    def holds(self, file: Path) -> bool:
        """Return whether a file, given by its path without links, is in the folder."""
        return file.is_relative_to(self.path) if self.recursive else file.parent == self.path


def record_named_files(words: Iterable[str]) -> None:
    """Record the folders of the descriptions and launch files that are among the words of a command line.

    Parameters
    ----------
    words
        Paths, or launch arguments ``name:=path``.
    """
    for word in words:
        path = word.partition(":=")[2] or word
        if path.lower().endswith((*_DESCRIPTIONS, *_LAUNCH_FILES)):
            with suppress(OSError, ValueError):  # no such file: who reads it complains
                if Path(path).is_file():
                    _record(_folder_of(Path(path).resolve()))


def record_model_path() -> None:
    """Record the folders of Gazebo's environment variables, which a studio elsewhere may not have."""
    from daidalos.description.resolve import environment_model_path

    for folder in environment_model_path():
        with suppress(OSError):
            if folder.is_dir():
                _record(AssetFolder(folder.resolve(), recursive=True))


def is_asset_readable(path: Path) -> bool:
    """Return whether a studio of this user may serve a mesh or texture.

    These are files in the share folders of packages, in the sources of their workspace, in the model path, and in
    the folders that programs of this user recorded.

    Parameters
    ----------
    path
        Of the file, without links.
    """
    from daidalos.description.fuel import fuel_caches
    from daidalos.description.resolve import default_model_path

    return (
        any(path.is_relative_to(folder.resolve()) for folder in (*default_model_path(), *fuel_caches()))
        or _is_in_package(path)
        or any(path.is_relative_to(folder) for folder in _workspace_sources())
        or any(folder.holds(path) for folder in _recorded())
    )


def _is_in_package(path: Path) -> bool:
    from ament_index_python.resources import has_resource
    from ament_index_python.search_paths import get_all_prefixes

    for prefix in get_all_prefixes():
        share = (Path(prefix) / "share").resolve()
        if path.is_relative_to(share):
            package = path.relative_to(share).parts[:1]
            if package and has_resource("packages", package[0]):
                return True
    return False


def _workspace_sources() -> Iterator[Path]:
    """Yield the source folders of the workspaces whose prefixes are in the environment.

    What lies in ``src`` may itself be a link, such as to a repository elsewhere. Links further down are not followed:
    they may have come with a repository.
    """
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        for workspace in list(Path(prefix).resolve().parents)[:2]:
            sources = workspace / "src"
            if sources.is_dir() and (workspace / "build").is_dir():
                yield sources.resolve()
                yield from (each.resolve() for each in sources.iterdir() if each.is_symlink() and each.is_dir())


def _folder_of(file: Path) -> AssetFolder:
    """Return the package or model that a file belongs to; its own folder where it belongs to none."""
    broad = {Path.home().resolve(), Path(tempfile.gettempdir()).resolve()}
    broad.update(*(folder.parents for folder in tuple(broad)))
    for folder in list(file.parents)[:_MAX_LEVELS_UP]:
        if folder in broad:
            break
        if any((folder / manifest).is_file() for manifest in _MANIFESTS):
            return AssetFolder(folder, recursive=True)
    return AssetFolder(file.parent, recursive=file.parent not in broad)


def _records_folder() -> Path:
    from daidalos.transport.registry import private_folder, runtime_folder

    return private_folder(runtime_folder() / "asset_folders")


def _record(folder: AssetFolder) -> None:
    from daidalos.transport.environment import EnvironmentVariableError
    from daidalos.transport.registry import open_private

    text = json.dumps([str(folder.path), folder.recursive]).encode()
    try:
        record = _records_folder() / f"{hashlib.sha256(text).hexdigest()[:32]}.json"
        file = open_private(record)
    except (OSError, EnvironmentVariableError):
        return  # the session complains of the runtime folder
    if file.tell() == 0:
        file.write(text)
        file.flush()
    with suppress(OSError):
        os.utime(record)
    _lock_shared(file)
    _held.append(file)


def _recorded() -> Iterator[AssetFolder]:
    """Yield the folders recorded by programs that run, or that ended not long ago; remove older records."""
    for record in _records_folder().glob("*.json"):
        with suppress(OSError, ValueError):
            if time.time() - record.stat().st_mtime > _LIFETIME_S and not _is_held(record):
                record.unlink(missing_ok=True)
                continue
            path, recursive = json.loads(record.read_bytes())
            yield AssetFolder(Path(path), recursive is True)


def _lock_shared(file: IO[bytes]) -> None:
    if sys.platform != "win32":
        import fcntl

        with suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)


def _is_held(record: Path) -> bool:
    """Return whether a process holds a record; where it cannot be asked, the record's age alone decides."""
    if sys.platform == "win32":
        return False
    import fcntl

    with record.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
    return False
