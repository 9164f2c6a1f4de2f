"""The compiler, CMake and Ninja: the machine's own, or those that PyPI carries."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
import sysconfig
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from daidalos.common.cache_folder import cache_folder
from daidalos.workspaces.errors import WorkspaceError

HINT = "run: pip install 'daidalos[cpp]'"


@dataclass(frozen=True)
class Toolchain:
    """Paths of the tools; `ninja` is empty where there is none, and `version` is what the compiler says of itself."""

    cmake: str
    ninja: str
    compiler: str
    c_compiler: str
    version: str

    @property
    def generator(self) -> list[str]:
        """Arguments of CMake that choose how it builds."""
        return ["-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={self.ninja}"] if self.ninja else []


def find_toolchain() -> Toolchain:
    """Return the tools.

    Raises
    ------
    WorkspaceError
        Naming what is missing and how to install it.
    """
    if sys.platform == "win32":
        raise WorkspaceError("C++ nodes are built on Linux and macOS only as yet; WSL is a way on Windows")
    cmake = _tool("cmake")
    compiler = _first(os.environ.get("CXX"), "c++", "g++", "clang++")
    c_compiler = _first(os.environ.get("CC"), "cc", "gcc", "clang")
    if not compiler and find_spec("ziglang"):
        compiler, c_compiler = _zig("c++"), _zig("cc")
    missing = [name for name, path in (("CMake", cmake), ("C++ compiler", compiler)) if not path]
    if missing:
        raise WorkspaceError(f"this machine has no {' and no '.join(missing)}: {HINT}")
    ninja = _tool("ninja")
    if not ninja and not shutil.which("make"):
        raise WorkspaceError(f"this machine has neither ninja nor make: {HINT}")
    done = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False)
    if done.returncode:
        raise WorkspaceError(f"the compiler '{compiler}' does not run: {done.stderr.strip()[:200]}")
    return Toolchain(cmake, ninja, compiler, c_compiler, done.stdout)


def _tool(name: str) -> str:
    """Return the path of a program of this environment or of the machine; empty if there is none."""
    own = Path(sysconfig.get_path("scripts")) / name
    return str(own) if own.is_file() else shutil.which(name) or ""


def _first(*names: str | None) -> str:
    return next(filter(None, (shutil.which(name) for name in names if name)), "")


def _zig(mode: str) -> str:
    """Return a script that runs PyPI's compiler, which CMake takes for a program."""
    folder = cache_folder() / "cpp" / "tools"
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / f"zig-{mode.replace('+', 'p')}"
    text = f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {mode} "$@"\n'
    if not script.is_file() or script.read_text() != text:
        script.write_text(text)
        script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return str(script)
