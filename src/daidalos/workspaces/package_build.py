"""Builds of packages of build type ament_cmake without CMake."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daidalos.interfaces.library import read_definition
from daidalos.workspaces.cmake.catkin import install_remaining
from daidalos.workspaces.cmake.contents import Contents
from daidalos.workspaces.cmake.reader import read_package
from daidalos.workspaces.compiling import Compilation, SkippedTarget, plan
from daidalos.workspaces.executables import LEFT_OUT
from daidalos.workspaces.installation import Installation
from daidalos.workspaces.interface_package import install_interfaces
from daidalos.workspaces.native.prefix import write_interfaces
from daidalos.workspaces.package_tests import write_tests

_INDEX = "share/ament_index/resource_index"
_RECORD = "installed_files.txt"


@dataclass(frozen=True)
class Place:
    """Source, build and install folders of a package."""

    source: Path
    build: Path
    prefix: Path
    python_folder: str
    symlink: bool
    catkin: bool = False


@dataclass
class Build:
    """Contents of a package, its compilations, and its targets that cannot be built."""

    contents: Contents
    compilations: list[Compilation]
    left_out: list[SkippedTarget]
    installation: Installation
    by_cmake: bool = False
    """Whether CMake has installed what it builds, with the C++ side of the package's interfaces."""

    @property
    def needs_cmake(self) -> bool:
        """Whether targets need C++ libraries, which only CMake finds."""
        return any(target.why == "C++" for target in self.left_out)


def begin(place: Place, cmake_arguments: Iterable[str] = ()) -> Build:
    """Read a package's CMakeLists.txt and plan the compilation.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    place.build.mkdir(parents=True, exist_ok=True)
    contents = read_package(place.source, place.build, place.prefix, place.python_folder, definitions(cmake_arguments))
    if place.catkin:
        install_remaining(place.source, contents)
    compilations, left_out = plan(contents.targets, place.build)
    installation = Installation(place.prefix, place.build / _RECORD, place.symlink)
    return Build(contents, compilations, left_out, installation)


def finish(
    build: Build, place: Place, name: str, run_dependencies: Sequence[str], environment: Mapping[str, str]
) -> None:
    """Install the package after compilation.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    contents, installation = build.contents, build.installation
    write_tests(contents.tests, place.build)
    prefixes = [Path(folder) for folder in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if folder]
    if contents.interfaces:
        install_interfaces(name, contents.interfaces.files, installation, place.python_folder, prefixes)
        if not build.by_cmake:
            interfaces = [read_definition(path, name) for path in contents.interfaces.files]
            for path in write_interfaces(name, interfaces, place.prefix):
                installation.register_installed(path)
    for file in contents.files:
        installation.put(file.source, file.destination, file.executable)
    for package in contents.python_packages:
        for script, function in package.scripts:
            _make_script(installation, package.scripts_destination, script, function)
    for compilation in build.compilations:
        if compilation.destination:
            installation.put(compilation.output, compilation.destination, executable=True)
    for resource in contents.resources:
        installation.write(f"{_INDEX}/{resource.type}/{resource.name}", resource.content)
    if build.left_out:
        sentences = (f"{target.name}: {target.sentence}\n" for target in build.left_out)
        installation.write(f"{_INDEX}/{LEFT_OUT}/{name}", "".join(sentences))
    installation.put(place.source / "package.xml", f"share/{name}/package.xml")
    installation.write(f"{_INDEX}/packages/{name}", "")
    installation.write(f"{_INDEX}/package_run_dependencies/{name}", ";".join(run_dependencies))
    installation.write(f"{_INDEX}/parent_prefix_path/{name}", os.pathsep.join(str(prefix) for prefix in prefixes))
    installation.finish()


def definitions(cmake_arguments: Iterable[str]) -> dict[str, str]:
    """Return the variables set by ``-DNAME=value`` and ``-DNAME:TYPE=value``."""
    found = {}
    for argument in cmake_arguments:
        if argument.startswith("-D"):
            name, _, value = argument[2:].partition("=")
            found[name.partition(":")[0]] = value
    return found


def _make_script(installation: Installation, destination: str, name: str, function: str) -> None:
    """Install a script that calls ``module:function``, in the form that the system needs."""
    from distlib.scripts import ScriptMaker

    folder = installation.prefix / destination
    folder.mkdir(parents=True, exist_ok=True)
    maker = ScriptMaker(None, str(folder))
    maker.executable = sys.executable
    maker.variants = {""}
    maker.clobber = maker.set_mode = True
    for path in maker.make(f"{name} = {function}"):
        installation.register_installed(Path(path))
