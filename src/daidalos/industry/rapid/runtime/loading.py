"""Programs read from files and loaded into a task."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.inspection import FileReport
from daidalos.industry.rapid.parsing import Parsed, parse
from daidalos.industry.rapid.sources import Program, find_programs, read_source

_BACKUP_TASK = re.compile(r"^>>(TASK\d+): *\((\w+),", re.MULTILINE)


def choose_programs(path: Path, tasks: Sequence[str] = ()) -> dict[str, Program]:
    """Return programs at a path by the names of their tasks: those that are named, else the only one.

    A task has the name that BACKINFO/backinfo.txt gives it in a controller's backup, else that of its program file or
    folder, such as TASK1; T_ROB1 stands for TASK1 too.

    Raises
    ------
    UserError
        If there is none, or if it is not said which.
    """
    found = find_programs(path)
    names = _backup_names(path)
    programs = {names.get(_task_name(one).upper(), _task_name(one)): one for one in found}
    if not tasks and len(programs) == 1:
        return {"T_ROB1": found[0]}
    if not tasks:
        raise UserError(f"{path}: there are several programs; choose with --task: {', '.join(programs)}")
    by_key = {name.lower(): one for name, one in programs.items()}
    by_key |= {_task_name(one).lower(): one for one in found}
    chosen: dict[str, Program] = {}
    for task in tasks:
        key = re.sub(r"^T_ROB(?=\d)", "TASK", task, flags=re.IGNORECASE).lower()
        one = by_key.get(task.lower(), by_key.get(key))
        if one is None:
            raise UserError(f"{path}: there is no task '{task}'{hint(task, programs)}")
        if task.upper() in chosen:
            raise UserError(f"{path}: --task {task} is given twice")
        chosen[task.upper()] = one
    return chosen


def _task_name(program: Program) -> str:
    return Path(program.name).stem


def _backup_names(path: Path) -> dict[str, str]:
    """Return the names of tasks by their folders in a backup, such as TASK1: T_ROB_R."""
    for folder in (path, path.parent):
        for file in folder.glob("BACKINFO/backinfo.txt"):
            text = file.read_bytes().decode("latin-1")
            return {match[1].upper(): match[2] for match in _BACKUP_TASK.finditer(text)}
    return {}


def load_modules(program: Program, signals: Iterable[str] = ()) -> tuple[list[Parsed], Checker, list[FileReport]]:
    """Return the modules of a program, their checker, and what keeps them from running.

    Raises
    ------
    UserError
        If a module cannot be read.
    """
    modules = [parse(read_source(file)) for file in program.files]
    checker = Checker(modules, signals)
    found = checker.check()
    blocking = [FileReport(file, [one for one in problems if not one.runs]) for file, problems in found.items()]
    return modules, checker, [report for report in blocking if report.errors]
