"""Dependencies of the packages below folders."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from daidalos.workspaces.manifest import read

_IGNORE = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_ATTRIBUTES = {
    "build": "build_depends",
    "buildtool": "buildtool_depends",
    "build_export": "build_export_depends",
    "buildtool_export": "buildtool_export_depends",
    "exec": "exec_depends",
    "test": "test_depends",
    "doc": "doc_depends",
}
TYPES = tuple(_ATTRIBUTES)
"""Types of dependencies."""


@dataclass(frozen=True)
class PackageDependencies:
    """Package and the names of its dependencies."""

    package: str
    keys: tuple[str, ...]


def find(folders: Iterable[Path], types: Iterable[str] = TYPES) -> list[PackageDependencies]:
    """Return the packages below folders with their dependencies of some types, in the order of the folders.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault in a package.xml.
    """
    return [needs for folder in folders for path in _manifests(folder) for needs in _needs(path, types)]


def _manifests(folder: Path) -> Iterator[Path]:
    for root, folders, files in os.walk(folder):
        if any(name in files for name in _IGNORE):
            folders.clear()
        elif "package.xml" in files:
            folders.clear()
            yield Path(root) / "package.xml"
        else:
            folders[:] = sorted(name for name in folders if not name.startswith("."))


def _needs(path: Path, types: Iterable[str]) -> Iterator[PackageDependencies]:
    package = read(path)
    if package is not None:
        depends = [one for kind in types for one in getattr(package, _ATTRIBUTES[kind])]
        names = dict.fromkeys(one.name for one in depends if one.evaluated_condition)
        yield PackageDependencies(package.name, tuple(names))
