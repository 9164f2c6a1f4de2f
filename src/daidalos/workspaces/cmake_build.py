"""Builds of packages whose C++ targets need libraries, by CMake."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.native import project as cmake
from daidalos.workspaces.native.prefix import compile_library, lay_out, library_packages
from daidalos.workspaces.native.toolchain import find_toolchain
from daidalos.workspaces.package_build import Build, Place

SWITCH = "DAIDALOS_CPP"
"""CMake variable that leaves C++ targets out of the build when it is OFF."""


@dataclass(frozen=True)
class Task:
    """Name and build dependencies of a package, CMake's arguments and the environment."""

    name: str
    depends: Sequence[str]
    arguments: Sequence[str]
    environment: Mapping[str, str]


def begin(build: Build, place: Place, task: Task, say: Callable[[str], None]) -> list[list[str]]:
    """Configure a package by CMake; return the commands that build and install it.

    There are none where tools or packages are missing: then the targets stay left out, and are said to be.

    Raises
    ------
    WorkspaceError
        When CMake refuses the package for another reason.
    """
    if place.catkin or f"-D{SWITCH}=OFF" in task.arguments:
        return []
    try:
        toolchain = find_toolchain()
        library = lay_out(toolchain)
    except WorkspaceError as error:
        _leave_out(build, str(error))
        return []
    project = cmake.Project(task.name, place.source, place.build, place.prefix, toolchain, library)
    if build.contents.interfaces:
        cmake.write_own_interfaces(project, build.contents.interfaces.files)
    try:
        said = cmake.configure(project, task.depends, task.arguments, task.environment)
    except cmake.MissingPackage as missing:
        there = ", ".join(library_packages())
        _leave_out(
            build,
            f"it needs the C++ package '{missing.package}', which is not there (of ROS there are {there} and the "
            f"message packages; a library of the system's is installed by its package manager)",
        )
        return []
    compile_library(library, toolchain, say)
    for line in said.strip().splitlines():
        say(line)
    build.left_out[:] = [target for target in build.left_out if target.why != "C++"]
    build.by_cmake = True
    build.compilations.clear()  # CMake builds all targets
    return cmake.build_commands(project)


def explain(completed: Any) -> str:
    """Return what to say of a compiler's failure; empty if its own words are enough."""
    output = b"".join(part for part in (completed.stdout, completed.stderr) if part)
    return cmake.explain(output.decode(errors="replace"))


def _leave_out(build: Build, why: str) -> None:
    build.left_out[:] = [
        replace(target, why=why, needs=()) if target.why == "C++" else target for target in build.left_out
    ]
