"""Hints about unknown packages and executables that are in the user's workspace."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

_DEEPEST = 3
"""Folders between ``src`` and a package at most."""

_SKIPPED_FOLDERS = {"build", "install", "log", "node_modules"}


def unknown_package(name: str) -> str:
    """Return a hint, with a leading line break, if the current workspace contains the package; else an empty text."""
    for workspace in _workspaces():
        if (workspace / "install" / name / "share" / name / "package.xml").is_file():
            return f"\nIt is built: run 'source {workspace / 'install' / 'setup.bash'}' in this terminal"
        if _source(workspace, name) is not None:
            return f"\nIt is in '{workspace / 'src'}': run 'colcon build' in '{workspace}', then source its setup file"
    return ""


def unknown_executable(package: str, executable: str) -> str:
    """Return a hint, with a leading line break, about an incomplete package of a workspace; else an empty text."""
    from ament_index_python.packages import get_package_prefix

    prefix = Path(get_package_prefix(package))
    file = prefix / "lib" / package / executable
    if file.is_file():
        return f"\n'{executable}' cannot be run: make it executable with 'chmod +x {file.resolve()}'"
    workspace = prefix.parent if prefix.parent.name != "install" else prefix.parent.parent
    source = _source(workspace, package)
    if source is None:
        return ""
    setup = source / "setup.py"
    if not setup.is_file():
        return f"\nDoes '{source / 'CMakeLists.txt'}' install it to lib/{package}? After a change, build again"
    if re.search(rf"['\"]\s*{re.escape(executable)}\s*=", setup.read_text(encoding="utf-8", errors="replace")):
        return f"\n'{setup}' names it: run 'colcon build' in '{workspace}' again"
    return f"\nName it under console_scripts in '{setup}', and run 'colcon build' in '{workspace}' again"


def _workspaces() -> Iterator[Path]:
    """Yield the folders upwards from the working directory that look like workspaces."""
    here = Path.cwd()
    for folder in (here, *here.parents):
        if (folder / "src").is_dir() and folder != Path.home().parent:
            yield folder


def _source(workspace: Path, package: str) -> Path | None:
    """Return the source folder of a package in a workspace."""
    name = re.compile(rf"<name>\s*{re.escape(package)}\s*</name>")
    pending = [(workspace / "src", 0)]
    while pending:
        folder, depth = pending.pop()
        manifest = folder / "package.xml"
        if manifest.is_file():
            if name.search(manifest.read_text(encoding="utf-8", errors="replace")):
                return folder
        elif folder.is_dir() and depth < _DEEPEST and folder.name not in _SKIPPED_FOLDERS:
            pending += [(child, depth + 1) for child in folder.iterdir() if child.name[:1] != "."]
    return None
