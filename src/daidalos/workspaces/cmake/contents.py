"""Contents of a package according to its CMakeLists.txt."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from daidalos.common.errors import Location


@dataclass(frozen=True)
class InstalledFile:
    """Installed file and its destination relative to the prefix; `executable` if it must be executable."""

    source: Path
    destination: str
    executable: bool = False


@dataclass(frozen=True)
class Resource:
    """Entry of the ament index."""

    type: str
    name: str
    content: str


@dataclass(frozen=True)
class PythonPackage:
    """Python package, with the executables of its setup.cfg (name, ``module:function``) and their destination."""

    name: str
    scripts_destination: str
    scripts: tuple[tuple[str, str], ...]


@dataclass
class Interfaces:
    """Files of rosidl_generate_interfaces and the location of that call."""

    files: list[Path]
    where: Location


@dataclass
class Target:
    """C++ executable or library: sources, linked libraries and destination, if any."""

    name: str
    kind: str
    where: Location
    sources: list[Path] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    includes: list[Path] = field(default_factory=list)
    definitions: list[str] = field(default_factory=list)
    options: list[str] = field(default_factory=list)
    output_name: str = ""
    standard: str = ""
    destination: str | None = None


@dataclass(frozen=True)
class Test:
    """Python test; `kind` is ``pytest`` or ``launch``, and it runs in `folder` or the build folder."""

    name: str
    kind: str
    path: Path
    arguments: tuple[str, ...] = ()
    timeout: float = 60.0
    environment: tuple[tuple[str, str], ...] = ()
    folder: str = ""


@dataclass
class Contents:
    """Contents of a package: installed files, and commands that were not understood."""

    project: str = ""
    files: list[InstalledFile] = field(default_factory=list)
    resources: list[Resource] = field(default_factory=list)
    python_packages: list[PythonPackage] = field(default_factory=list)
    interfaces: Interfaces | None = None
    targets: dict[str, Target] = field(default_factory=dict)
    tests: list[Test] = field(default_factory=list)
    left_out_tests: list[str] = field(default_factory=list)
    hooks: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
