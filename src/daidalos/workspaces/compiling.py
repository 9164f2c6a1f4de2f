"""Compilation of C++ executables that need only a compiler, and reasons why others are skipped."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daidalos.workspaces.cmake.contents import Target

_SYSTEM_LIBRARIES = {"m": "-lm", "dl": "-ldl", "rt": "-lrt", "pthread": "-pthread", "Threads::Threads": "-pthread"}
_SYSTEM_LIBRARIES["${CMAKE_THREAD_LIBS_INIT}"] = "-pthread"
_SHOWN = 4
_CPP = {".cpp", ".cc", ".cxx", ".C"}
_C = {".c"}


@dataclass(frozen=True)
class Compilation:
    """Command that compiles an executable, and its destination."""

    command: list[str]
    output: Path
    destination: str


@dataclass(frozen=True)
class SkippedTarget:
    """Target that is not built, with the reason and its missing dependencies."""

    name: str
    why: str
    needs: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What became of the target, for whoever looks for it."""
        if not self.needs:
            return f"'{self.name}' was left out of the build: {self.why}"
        return f"'{self.name}' is {self.why} and was left out of the build: it needs {_short(self.needs)}"


def plan(targets: Mapping[str, Target], build: Path) -> tuple[list[Compilation], list[SkippedTarget]]:
    """Return the build commands of a package's executables, and the targets that cannot be built.

    Libraries are compiled into the executables that use them; nobody else can load them here.

    Parameters
    ----------
    targets
        What CMakeLists.txt declares, by name.
    build
        Where executables are put before they are installed.
    """
    compilations: list[Compilation] = []
    left_out: list[SkippedTarget] = []
    for target in targets.values():
        foreign = _foreign(target, targets)
        if target.kind == "executable":
            compiler = _compiler(target, targets)
            if foreign:
                left_out.append(SkippedTarget(target.name, "C++", tuple(foreign)))
            elif compiler is None:
                left_out.append(SkippedTarget(target.name, "this machine has no C++ compiler"))
            else:
                compilations.append(_compilation(target, targets, compiler, build))
        elif target.sources and target.destination and foreign:
            left_out.append(SkippedTarget(target.name, "C++", tuple(foreign)))
    return compilations, left_out


def summary(left_out: Iterable[SkippedTarget]) -> str:
    """Return one line about the skipped targets; empty if there are none."""
    by_reason: dict[str, list[SkippedTarget]] = {}
    for target in left_out:
        by_reason.setdefault(target.why, []).append(target)
    parts = [f"{', '.join(one.name for one in group)} ({_reason(why, group)})" for why, group in by_reason.items()]
    return f"left out: {'; '.join(parts)}" if parts else ""


def _reason(why: str, group: Iterable[SkippedTarget]) -> str:
    needs = list(dict.fromkeys(name for target in group for name in target.needs))
    if not needs:
        return why
    return f"{why} that needs {_short(needs)}"


def _short(needs: Sequence[str]) -> str:
    shown = ", ".join(needs[:_SHOWN]) + (" and more" if len(needs) > _SHOWN else "")
    return f"{shown}, of which only the Python side comes with Daidalos"


def _parts(target: Target, targets: Mapping[str, Target]) -> list[Target]:
    """Return a target with the package's own libraries that it links, directly or not."""
    found: dict[str, Target] = {}
    pending = [target]
    while pending:
        part = pending.pop()
        if part.name not in found:
            found[part.name] = part
            pending += [targets[link] for link in part.links if link in targets]
    return list(found.values())


def _foreign(target: Target, targets: Mapping[str, Target]) -> list[str]:
    """Return the external packages that a target needs.

    The library of the package's own messages is linked by a variable that nothing sets here.
    """
    names = [
        link.split("::")[0].removeprefix("-l") or "its own messages"
        for part in _parts(target, targets)
        for link in part.links
        if link not in targets and link not in _SYSTEM_LIBRARIES
    ]
    return list(dict.fromkeys(names))


def _compiler(target: Target, targets: Mapping[str, Target]) -> str | None:
    suffixes = {path.suffix for part in _parts(target, targets) for path in part.sources}
    names = (os.environ.get("CC"), "cc", "gcc", "clang")
    if suffixes & _CPP or not suffixes & _C:
        names = (os.environ.get("CXX"), "c++", "g++", "clang++")
    return next(filter(None, (shutil.which(name) for name in names if name)), None)


def _compilation(target: Target, targets: Mapping[str, Target], compiler: str, build: Path) -> Compilation:
    output = build / (target.output_name or target.name)
    parts = _parts(target, targets)
    command = [compiler, "-O2", f"-std=c++{target.standard or '17'}"]
    if all(path.suffix in _C for part in parts for path in part.sources):
        command.pop()
    for part in parts:
        command += part.options
        command += [f"-D{name}" for name in part.definitions]
        command += [f"-I{folder}" for folder in part.includes if folder.is_dir()]
    command += [str(path) for part in parts for path in part.sources if path.suffix in _CPP | _C]
    command += ["-o", str(output)]
    links = [_SYSTEM_LIBRARIES[link] for part in parts for link in part.links if link in _SYSTEM_LIBRARIES]
    destination = f"{target.destination}/{output.name}" if target.destination else ""
    return Compilation([*command, *dict.fromkeys(links)], output, destination)
