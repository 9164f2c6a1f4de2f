"""Command lines that a lock-step run carries out as programs of its own process: those of this Python."""

from __future__ import annotations

import os
import runpy
import shutil
import signal
import sys
import sysconfig
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from daidalos.nodes import start
from daidalos.workspaces import run_script
from daidalos.workspaces.executables import built_in_program, is_script_of_this_python


def body_of(command: Sequence[str], environ: Mapping[str, str]) -> tuple[list[str], Callable[[], Any]] | None:
    """Return the ``sys.argv`` and the body of the program that a command line starts; None for foreign programs."""
    built_in = built_in_program(command)
    if built_in is not None:
        return _built_in(*built_in)
    if _is_this_python(command[0]):
        return _python(command[1:])
    path = shutil.which(command[0], path=environ.get("PATH")) or shutil.which(command[0], path=_own_scripts())
    if path is None or not is_script_of_this_python(Path(path)):
        return None
    return _script(path, command[1:])


def _built_in(package: str, module: str, arguments: list[str]) -> tuple[list[str], Callable[[], Any]]:
    def body() -> int:
        sys.excepthook = start.show
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        return start.run_module(package, module, arguments)

    return [module, *arguments], body


def _python(arguments: Sequence[str]) -> tuple[list[str], Callable[[], Any]] | None:
    rest = list(arguments)
    while rest and rest[0] in ("-u", "-B", "-E", "-I", "-s", "-S", "-P"):
        rest.pop(0)
    if not rest or rest[0] == "-c" or (rest[0].startswith("-") and rest[0] != "-m"):
        return None
    if rest[0] == "-m":
        name = rest[1]
        return [name, *rest[2:]], lambda: runpy.run_module(name, run_name="__main__", alter_sys=False) and 0
    argv, body = _script(rest[0], rest[1:])
    return argv, lambda: body() if _can_open(argv[0]) else 2


def _can_open(path: str) -> bool:
    """Return whether a script can be read; report it as the interpreter does where not."""
    try:
        with open(path, "rb"):
            return True
    except OSError as error:
        place = os.path.abspath(path)
        sys.stderr.write(f"{sys.executable}: can't open file '{place}': [Errno {error.errno}] {error.strerror}\n")
        return False


def _script(path: str, arguments: Sequence[str]) -> tuple[list[str], Callable[[], Any]]:
    def body() -> int:
        sys.path.insert(0, os.path.dirname(os.path.realpath(path)))
        run_script.run(path)
        return 0

    return [path, *arguments], body


def _is_this_python(program: str) -> bool:
    own = Path(sys.executable)
    if os.path.isabs(program):
        other = Path(program)
        return other.resolve() == own.resolve() and other.name.startswith("python")
    return program in ("python", "python3", own.name)


def _own_scripts() -> str:
    return sysconfig.get_path("scripts")
