"""Reader of a package's CMakeLists.txt."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Mapping
from pathlib import Path

from daidalos.common.errors import Location
from daidalos.workspaces.cmake import basics, catkin, installs, targets
from daidalos.workspaces.cmake.contents import Contents
from daidalos.workspaces.cmake.interpreter import Interpreter
from daidalos.workspaces.errors import WorkspaceError

_HANDLERS = basics.COMMANDS | installs.COMMANDS | targets.COMMANDS | catkin.COMMANDS
_IGNORED = basics.IGNORED | installs.IGNORED | targets.IGNORED | catkin.IGNORED


def read_package(
    folder: Path, build: Path, prefix: Path, python_folder: str, definitions: Mapping[str, str] | None = None
) -> Contents:
    """Return what a package installs.

    Parameters
    ----------
    folder
        Where its CMakeLists.txt is.
    build
        Where files that its commands make may be put.
    prefix
        Where it will be installed.
    python_folder
        Where Python packages go, relative to the prefix.
    definitions
        Variables from the command line (``-DNAME=value``).

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    path = folder / "CMakeLists.txt"
    if not path.is_file():
        raise WorkspaceError("a package of build type ament_cmake needs a CMakeLists.txt", Location(str(folder)))
    variables = _variables(folder, build, prefix) | {"PYTHON_INSTALL_DIR": python_folder}
    interpreter = Interpreter(_HANDLERS, _IGNORED, variables | dict(definitions or {}), folder)
    interpreter.run_file(path)
    if not interpreter.contents.project:
        raise WorkspaceError("there is no project() with the package's name", Location(str(path)))
    return interpreter.contents


def _variables(folder: Path, build: Path, prefix: Path) -> dict[str, str]:
    variables = {
        name: str(folder) for name in ("CMAKE_SOURCE_DIR", "CMAKE_CURRENT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR")
    }
    variables |= {name: str(build) for name in ("CMAKE_BINARY_DIR", "CMAKE_CURRENT_BINARY_DIR")}
    variables |= {
        "CMAKE_INSTALL_PREFIX": str(prefix),
        "CMAKE_INSTALL_BINDIR": "bin",
        "CMAKE_INSTALL_LIBDIR": "lib",
        "CMAKE_INSTALL_INCLUDEDIR": "include",
        "CMAKE_INSTALL_DATADIR": "share",
        "CMAKE_VERSION": "3.28.3",
        "CMAKE_MAJOR_VERSION": "3",
        "CMAKE_MINOR_VERSION": "28",
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_SYSTEM_NAME": platform.system(),
        "CMAKE_SYSTEM_PROCESSOR": platform.machine(),
        "CMAKE_CXX_COMPILER_ID": "GNU",
        "CMAKE_COMPILER_IS_GNUCXX": "1",
        "BUILD_TESTING": "ON",
        "PYTHON_EXECUTABLE": sys.executable,
        "Python3_EXECUTABLE": sys.executable,
        "PYTHON_VERSION": platform.python_version(),
        "AMENT_PREFIX_PATH": os.environ.get("AMENT_PREFIX_PATH", "").replace(os.pathsep, ";"),
    }
    variables |= {"WIN32": "1"} if sys.platform == "win32" else {"UNIX": "1"}
    return variables | ({"APPLE": "1"} if sys.platform == "darwin" else {})
