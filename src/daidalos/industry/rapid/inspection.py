"""Check of whole programs: files, folders and program files."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError
from daidalos.industry.rapid.checking import check
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import find_programs, read_source

_SIGNAL = re.compile(r'-Name\s+"(?P<name>[^"]+)"(?=[^\n]*-SignalType)')
_CONTINUED = re.compile(r"\\\s*\n\s*")


@dataclass(frozen=True)
class FileReport:
    """What was found in a file."""

    file: str
    errors: list[Problem] = field(default_factory=list)
    warnings: list[Problem] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        """Return what ``--json`` prints of the file."""
        return {
            "file": self.file,
            "errors": [_as_json(one) for one in self.errors],
            "warnings": [_as_json(one) for one in self.warnings],
        }


def inspect(path: Path, signals: Iterable[str] = ()) -> list[FileReport]:
    """Check the programs at a path: a module, a program file or a folder.

    Raises
    ------
    UserError
        If there is nothing to check at the path. What is wrong with one of several files is part of its report.
    """
    known = list(signals)
    reports: list[FileReport] = []
    for program in find_programs(path):
        parsed, unreadable = [], []
        for file in program.files:
            try:
                parsed.append(parse(read_source(file)))
            except UserError as error:
                message = str(error).removeprefix(f"{file}: ")
                unreadable.append(FileReport(str(file), [Problem(1, 1, message, "syntax")]))
        found = check(parsed, known, is_complete=not unreadable)
        reports += unreadable
        for file_name, problems in found.items():
            errors = [one for one in problems if not one.is_warning]
            reports.append(FileReport(file_name, errors, [one for one in problems if one.is_warning]))
    return sorted(reports, key=lambda report: report.file)


def read_signals(path: Path) -> list[str]:
    """Return the names of the signals that a controller's configuration of I/O (EIO.cfg) declares.

    Raises
    ------
    UserError
        If the file cannot be read.
    """
    text = _CONTINUED.sub(" ", read_source(path).text)
    names = [match["name"] for match in _SIGNAL.finditer(text)]
    if not names:
        raise UserError(f'{path}: no signal in it; a line such as -Name "do1" -SignalType "DO" is expected')
    return names


def _as_json(problem: Problem) -> dict[str, Any]:
    return {"line": problem.line, "column": problem.column, "kind": problem.kind, "message": problem.message}
