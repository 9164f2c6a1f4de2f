"""Programs read from files and loaded into a task."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.inspection import FileReport
from daidalos.industry.rapid.parsing import Parsed, parse
from daidalos.industry.rapid.sources import Program, find_programs, read_source


def choose_program(path: Path, task: str | None) -> Program:
    """Return the program at a path; in a folder with several, that of a task, such as T_ROB1 or TASK1.

    Raises
    ------
    UserError
        If there is none, or if it is not said which.
    """
    programs = {_task_name(one): one for one in find_programs(path)}
    if task is None and len(programs) == 1:
        return next(iter(programs.values()))
    if task is None:
        raise UserError(f"{path}: there are several programs; choose one by --task: {', '.join(programs)}")
    key = re.sub(r"^T_ROB(?=\d)", "TASK", task, flags=re.IGNORECASE).lower()
    found = next((one for name, one in programs.items() if name.lower() in (key, task.lower())), None)
    if found is None:
        raise UserError(f"{path}: there is no task '{task}'{hint(task, programs)}")
    return found


def _task_name(program: Program) -> str:
    return Path(program.name).stem


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
