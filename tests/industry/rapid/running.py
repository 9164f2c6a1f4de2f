"""Programs that tests run, and what they have written."""

from collections.abc import Sequence
from typing import Any

from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.pendant import TextPendant
from daidalos.industry.rapid.runtime.task import Outcome, Task

from .programs import module, parsed


def load(text: str, answers: Sequence[str] = (), **more: Any) -> Task:
    """Load a module that has no errors."""
    found = parsed(text)
    checker = Checker([found])
    blocking = [problem for problem in checker.check()["test.mod"] if not problem.runs]
    assert blocking == []
    waiting = list(answers)

    def read(prompt: str) -> str:
        if not waiting:
            raise EOFError
        return waiting.pop(0)

    return Task([found], checker, pendant=TextPendant(read, lambda line: None), **more)


def run(lines: str, declarations: str = "", answers: Sequence[str] = (), **more: Any) -> tuple[Outcome, list[str]]:
    """Run lines in a procedure, and return how that ended and what was written."""
    task = load(module(lines, declarations), answers, **more)
    outcome = task.run()
    assert isinstance(task.pendant, TextPendant)
    return outcome, task.pendant.lines


def written(lines: str, declarations: str = "", answers: Sequence[str] = ()) -> list[str]:
    """Return what lines write; they have to come to their end."""
    outcome, found = run(lines, declarations, answers)
    assert outcome.reason == "end", outcome.message
    return found


def board(**values: float) -> Board:
    """Return a board with signals."""
    return Board((), values)
