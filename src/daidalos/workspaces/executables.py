"""Commands that start the executables of packages."""

from __future__ import annotations

import ast
import contextlib
import os
import shutil
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from daidalos.common.suggestions import hint

BUILT_IN = Path(__file__).resolve().parents[1] / "nodes"
"""Folder of the built-in packages, with a subfolder of modules for each."""

_START = str(BUILT_IN / "start.py")
LEFT_OUT = "left_out_of_the_build"
"""Type of the resource that says, line by line, which targets of a package were not built, and why."""

_RUN_SCRIPT = str(Path(__file__).with_name("run_script.py"))


class ExecutableNotFound(LookupError):
    """Unknown executable; the message lists similar names."""


def find_executable(package: str, executable: str) -> list[str]:
    """Return the start of an executable's command line, to be followed by its arguments.

    Packages of the user's workspaces come before the built-in ones.

    Raises
    ------
    ExecutableNotFound
        When the package is unknown or has no such executable.
    """
    for folder in _folders(package):
        path = folder / executable
        if _is_executable(path):
            return [str(path)]
    if executable in _modules(package):
        return built_in_command(package, executable)
    known = executables(package)
    if not known and not is_known(package):
        raise ExecutableNotFound(f"Package '{package}' not found")
    reason = left_out(package, executable)
    if reason:
        raise ExecutableNotFound(f"No executable '{executable}' in package '{package}': {reason}")
    raise ExecutableNotFound(f"No executable '{executable}' in package '{package}'{hint(executable, known)}")


def built_in_command(package: str, executable: str) -> list[str]:
    """Return the beginning of the command that starts an executable of a built-in package, whatever is sourced."""
    return [sys.executable, "-S", "-P", _START, package, _modules(package)[executable]]


def built_in_program(command: Sequence[str]) -> tuple[str, str, list[str]] | None:
    """Return the package, module and arguments of a command line of a built-in executable, None for any other."""
    if _START not in command[:4]:
        return None
    package, module, *arguments = command[list(command).index(_START) + 1 :]
    return package, module, arguments


def reporting_command(command: Sequence[str]) -> list[str]:
    """Return a command line that reports uncaught exceptions of a package's Python script without frames of libraries.

    Other command lines, and scripts for another interpreter, are returned as they are.
    """
    path = Path(command[0])
    if path.is_absolute() and path.parent in _folders(path.parent.name) and is_script_of_this_python(path):
        return [sys.executable, _RUN_SCRIPT, *command]
    return list(command)


def is_starting_something(since_s: float) -> bool:
    """Return whether an executable of a package was started in this domain within so many seconds."""
    import psutil

    domain = os.environ.get("ROS_DOMAIN_ID", "")
    for process in psutil.process_iter(["cmdline", "create_time"]):
        with contextlib.suppress(psutil.Error, OSError):
            words = process.info["cmdline"] or ()
            is_new = process.info["create_time"] > time.time() - since_s
            if (
                is_new
                and (_START in words or _RUN_SCRIPT in words)
                and process.environ().get("ROS_DOMAIN_ID", "") == domain
            ):
                return True
    return False


@contextlib.contextmanager
def interrupts_blocked(command: Sequence[str]) -> Iterator[None]:
    """Block Ctrl-C for a built-in executable while it starts; it unblocks the signal itself.

    Any other command is left alone, as it would never unblock the signal.
    """
    if _START not in command[:4] or not hasattr(signal, "pthread_sigmask"):
        yield
        return
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])


def executables(package: str) -> list[str]:
    """Return the sorted names of a package's executables."""
    found = {path.name for folder in _folders(package) for path in _files(folder)}
    return sorted(found | _modules(package).keys())


def executable_path(package: str, executable: str) -> Path:
    """Return the file behind an executable; see `find_executable` for what it raises."""
    command = find_executable(package, executable)
    return Path(command[0]) if len(command) == 1 else BUILT_IN / package / f"{command[-1]}.py"


def left_out(package: str, target: str) -> str:
    """Return why the build of a package left out an executable or a library; empty for any other name."""
    return all_left_out(package).get(target, "")


def all_left_out(package: str) -> dict[str, str]:
    """Return the executables and libraries that the build of a package left out, and why: name -> sentence."""
    from ament_index_python.resources import get_resource

    try:
        text, _ = get_resource(LEFT_OUT, package)
    except (LookupError, OSError, ValueError):
        return {}
    return {name: sentence for name, _, sentence in (line.partition(": ") for line in text.splitlines())}


def is_known(package: str) -> bool:
    """Return whether a package of this name exists, in a workspace or built in."""
    from ament_index_python.packages import PackageNotFoundError, get_package_prefix

    try:
        get_package_prefix(package)
    except (PackageNotFoundError, ValueError):
        return (BUILT_IN / package).is_dir()
    return True


def _folders(package: str) -> list[Path]:
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    return [Path(prefix) / "lib" / package for prefix in prefixes if prefix]


def _files(folder: Path) -> list[Path]:
    return [path for path in folder.iterdir() if _is_executable(path)] if folder.is_dir() else []


def is_script_of_this_python(path: Path) -> bool:
    """Return whether a file is a Python script that the interpreter of this process would run."""
    try:
        with path.open("rb") as file:
            line = file.readline()
    except OSError:
        return False
    words = line[2:].decode(errors="replace").split() if line.startswith(b"#!") else []
    if len(words) == 2 and Path(words[0]).name == "env":
        words = [shutil.which(words[1]) or ""]
    if len(words) != 1:
        return False
    own, other = Path(sys.executable), Path(words[0])
    return other.parent == own.parent and other.name.startswith("python") and other.resolve() == own.resolve()


def _is_executable(path: Path) -> bool:
    return path.is_file() and (sys.platform == "win32" or os.access(path, os.X_OK))


def _modules(package: str) -> dict[str, str]:
    """Return the built-in executables of a package: name -> module.

    A module stands for the executable of its name. ROS 2 calls some executables ``name.py``: such a name is
    listed where the package's ``__init__`` says so in ``EXECUTABLES`` (executable -> module).
    """
    folder = BUILT_IN / package
    if not (folder / "__init__.py").is_file():
        return {}
    found = {path.stem: path.stem for path in folder.glob("*.py") if not path.stem.startswith("_")}
    renamed = _renamed(folder)
    for module in renamed.values():
        found.pop(module, None)
    return found | renamed


def _renamed(folder: Path) -> dict[str, str]:
    """Return the literal ``EXECUTABLES`` of a package's ``__init__``, read without importing the package."""
    text = (folder / "__init__.py").read_text(encoding="utf-8")
    if "EXECUTABLES" not in text:
        return {}
    for statement in ast.parse(text).body:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "EXECUTABLES":
            names: dict[str, str] = ast.literal_eval(statement.value)
            return names
    return {}
