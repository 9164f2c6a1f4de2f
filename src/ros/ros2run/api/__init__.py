"""Executables of packages."""

from __future__ import annotations

import subprocess
from argparse import Namespace
from collections.abc import Sequence
from typing import Any

from ros2pkg.api import PackageNotFound

from daidalos.workspaces.executables import (
    ExecutableNotFound,
    executable_path,
    executables,
    find_executable,
    interrupts_blocked,
    is_known,
    reporting_command,
)
from daidalos.workspaces.orphans import guard


class MultipleExecutables(Exception):
    """An executable of a package is there more than once.

    Parameters
    ----------
    paths
        Where.
    """

    def __init__(self, paths: Sequence[str]) -> None:
        super().__init__(f"there are several: {', '.join(paths)}")
        self.paths = list(paths)


def get_executable_path(*, package_name: str, executable_name: str) -> str | None:
    """Return the file of an executable; None where the package has no such executable.

    Raises
    ------
    PackageNotFound
        When there is no such package.
    """
    try:
        return str(executable_path(package_name, executable_name))
    except ExecutableNotFound:
        _check(package_name)
        return None


def get_executable_paths(*, package_name: str) -> list[str]:
    """Return the files of a package's executables.

    Raises
    ------
    PackageNotFound
        When there is no such package.
    """
    _check(package_name)
    return [str(executable_path(package_name, name)) for name in executables(package_name)]


def run_executable(*, path: str, argv: Sequence[str], prefix: str | Sequence[str] | None = None) -> int:
    """Run an executable with arguments, and return its exit status.

    Parameters
    ----------
    path
        The executable's file.
    argv
        Its arguments.
    prefix
        The command that goes before it.
    """
    import shlex

    before = shlex.split(prefix) if isinstance(prefix, str) else list(prefix or [])
    command = reporting_command([*before, *_command(path), *argv])
    with interrupts_blocked(command):
        process = subprocess.Popen(command)
    guard.watch(process.pid)
    while process.returncode is None:
        try:
            process.communicate()
        except KeyboardInterrupt:
            # It got the signal, too, and ends in its own time.
            continue
    guard.release(process.pid)
    return process.returncode


class ExecutableNameCompleter:
    """Completer of the executables of the package that another argument names.

    Parameters
    ----------
    package_name_key
        The other argument.
    """

    def __init__(self, *, package_name_key: str) -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        return executables(getattr(parsed_args, self.package_name_key))


def _check(package_name: str) -> None:
    if not is_known(package_name):
        raise PackageNotFound(package_name)


def _command(path: str) -> list[str]:
    """Return what starts a file; those of our own packages are modules."""
    from pathlib import Path

    from daidalos.workspaces.executables import BUILT_IN

    file = Path(path)
    if file.parent.parent == BUILT_IN:
        package = file.parent.name
        for name in executables(package):
            if executable_path(package, name) == file:
                return find_executable(package, name)
    return [path]
