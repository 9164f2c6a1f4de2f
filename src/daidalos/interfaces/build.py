"""Generator of the Python classes of the built-in definitions, run by the build hook."""

from __future__ import annotations

import shutil
from pathlib import Path

from daidalos.interfaces.generator import write_package
from daidalos.interfaces.library import Library


def write_built_in(share: Path, target: Path) -> list[Path]:
    """Write every interface package under `share` to `target` and remove what is no longer defined.

    Raises
    ------
    InterfaceError
        Naming the file and line of a faulty definition.
    """
    library = Library([share])
    written: list[Path] = []
    for package in library.packages():
        interfaces = [library.get(name) for name in library.names(package)]
        written += write_package(package, interfaces, library.get, target)
    _remove_others(target, set(written))
    return written


def _remove_others(target: Path, keep: set[Path]) -> None:
    for path in sorted(target.rglob("*.py")):
        if path not in keep:
            path.unlink()
    packages = {path.relative_to(target).parts[0] for path in keep}
    for folder in target.iterdir():
        if folder.is_dir() and folder.name not in packages:
            shutil.rmtree(folder)
