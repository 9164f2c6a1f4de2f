"""The build of one package by CMake: commands, and what CMake's complaints mean."""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daidalos.interfaces.library import read_definition
from daidalos.interfaces.parser import InterfaceError
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.native.prefix import compilers, library_packages, write_interfaces
from daidalos.workspaces.native.toolchain import Toolchain

_MISSING = re.compile(
    r'package\s+configuration\s+file\s+provided\s+by\s+"([\w.-]+)"|Could NOT find (\w+)'
    r"|passed\s+package\s+name\s+'([\w.-]+)'\s+was\s+not\s+found"
)
_NO_HEADER = re.compile(r"fatal error: '?([\w./+-]+)'?(?::| file not found)")


class MissingPackage(Exception):
    """CMake did not find a package; `package` is its name."""

    def __init__(self, package: str) -> None:
        super().__init__(package)
        self.package = package


@dataclass(frozen=True)
class Project:
    """Folders of a package, and the tools and the prefix to build it with."""

    name: str
    source: Path
    build: Path
    prefix: Path
    toolchain: Toolchain
    library: Path


def write_own_interfaces(project: Project, files: Sequence[Path]) -> None:
    """Write the headers of the package's own interfaces where ``rosidl_generate_interfaces`` looks for them.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    try:
        interfaces = [read_definition(path, project.name) for path in files]
    except InterfaceError as error:
        raise WorkspaceError(str(error)) from None
    write_interfaces(project.name, interfaces, project.build / "daidalos")


def configure(
    project: Project, depends: Sequence[str], arguments: Sequence[str], environment: Mapping[str, str]
) -> str:
    """Configure the package; return what CMake said.

    Raises
    ------
    MissingPackage
        When CMake does not find one.
    WorkspaceError
        When something else is wrong; the message is CMake's.
    """
    prefixes = [folder for folder in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if folder]
    command = [
        project.toolchain.cmake, "-S", str(project.source), "-B", str(project.build), *project.toolchain.generator,
        "--no-warn-unused-cli", *compilers(project.toolchain),
        f"-DCMAKE_PREFIX_PATH={';'.join([*prefixes, str(project.library)])}",
        f"-DCMAKE_INSTALL_PREFIX={project.prefix}",
        "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DBUILD_TESTING=OFF",
        "-DCMAKE_FIND_PACKAGE_PREFER_CONFIG=OFF", "-DCMAKE_INSTALL_RPATH_USE_LINK_PATH=ON",
        "-DCMAKE_INSTALL_RPATH=$ORIGIN;$ORIGIN/..", f"-DDAIDALOS_BUILD_DEPENDS={';'.join(depends)}",
        "-DCMAKE_POLICY_VERSION_MINIMUM=3.5", *arguments,
    ]  # fmt: skip
    _forget_other_library(project)
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=dict(environment))
    if done.returncode:
        missing = missing_package(done.stderr)
        if missing:
            raise MissingPackage(missing)
        raise WorkspaceError(f"CMake cannot configure the package:\n{done.stderr.strip()}")
    return done.stderr


def missing_package(text: str) -> str | None:
    """Return the package that CMake's complaints say is missing; None where they say something else."""
    missing = _MISSING.search(text)
    return next(name for name in missing.groups() if name) if missing else None


def _forget_other_library(project: Project) -> None:
    """Remove CMake's cache when it was made with another prefix, whose paths it would keep."""
    record = project.build / "daidalos_library.txt"
    if record.is_file() and record.read_text() == str(project.library):
        return
    (project.build / "CMakeCache.txt").unlink(missing_ok=True)
    project.build.mkdir(parents=True, exist_ok=True)
    record.write_text(str(project.library))


def build_commands(project: Project) -> list[list[str]]:
    """Return the commands that compile and install."""
    cmake, build = project.toolchain.cmake, str(project.build)
    return [[cmake, "--build", build, "--parallel"], [cmake, "--install", build]]


def explain(output: str) -> str:
    """Return what to say about a compiler's output that ends in a missing header; empty if it does not."""
    found = _NO_HEADER.search(output)
    if not found:
        return ""
    package = found[1].split("/")[0]
    there = ", ".join(library_packages())
    return (
        f"there is no header '{found[1]}': if '{package}' is a package of ROS, Daidalos has its C++ side only for "
        f"the message packages and for {there}; a package of the workspace has to be in package.xml and find_package()"
    )
