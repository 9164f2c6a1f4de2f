"""What a CMakeLists.txt says that the package consists of."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class InstalledFile:
    """A file and where it goes, relative to the prefix; `executable` where it must be so."""

    source: Path
    destination: str
    executable: bool = False


@dataclass(frozen=True)
class Resource:
    """An entry of the ament index."""

    type: str
    name: str
    content: str


@dataclass(frozen=True)
class PythonPackage:
    """A Python package with the executables of its setup.cfg (name, ``module:function``) and where these go."""

    name: str
    scripts_destination: str
    scripts: tuple[tuple[str, str], ...]


@dataclass
class Interfaces:
    """The files given to rosidl_generate_interfaces, and where that is said."""

    files: list[Path]
    where: str


@dataclass
class Target:
    """An executable or library in C++: its files, what it links, and where it is installed if it is."""

    name: str
    kind: str
    where: str
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
    """A test of Python files; `kind` is ``pytest`` or ``launch``, and it runs in `folder`, or the build folder."""

    name: str
    kind: str
    path: Path
    arguments: tuple[str, ...] = ()
    timeout: float = 60.0
    environment: tuple[tuple[str, str], ...] = ()
    folder: str = ""


@dataclass
class Contents:
    """All that a package would install, and what was not understood."""

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
