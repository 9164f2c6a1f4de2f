"""A debugger of one task: breakpoints, steps, the program pointer and the stack of calls.

A program is Python, of which each line belongs to a line of RAPID, so the debugger is a trace function of Python's: it
costs nothing where it is not used.
"""

from __future__ import annotations

import queue
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any, Literal

from daidalos.industry.rapid.runtime.errors import ProgramEnd, RapidError
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.runtime.translation import FILE

Command = Literal["continue", "in", "over", "out", "end"]
Place = tuple[str, int]


@dataclass(frozen=True)
class Call:
    """A call of a routine that has not returned.

    Attributes
    ----------
    frame
        Frame of Python.
    file, line
        Where it is.
    routine
        Name of the routine.
    is_handler
        Whether its error handler runs.
    """

    frame: FrameType
    file: str
    line: int
    routine: str
    is_handler: bool


@dataclass
class Debugger:
    """Stops a task at lines, and says where it is.

    Attributes
    ----------
    task
        The task; it was loaded for debugging.
    on_stop
        Called in the task's thread with why it has stopped: ``entry``, ``breakpoint``, ``step``, ``pause``, ``goto`` or
        ``exception``, and a text.
    breakpoints
        Lines by the resolved paths of files, each with a condition that has to hold, or none.
    stops_at_errors
        Whether an error stops the task where it is raised, handled or not.
    """

    task: Task
    on_stop: Callable[[str, str], None]
    breakpoints: dict[str, dict[int, Callable[[], bool] | None]] = field(default_factory=dict)
    stops_at_errors: bool = False
    is_stopped: bool = False
    place: Place = ("", 0)
    """File and line of the program pointer."""
    _command: Command = "in"
    _depth: int = 0
    _start: int = 0
    _asks_pause: bool = False
    _reason: str = "entry"
    _jump: int | None = None
    _frame: FrameType | None = None
    _places: dict[FrameType, Place] = field(default_factory=dict)
    _error: BaseException | None = None
    _commands: queue.Queue[Command] = field(default_factory=queue.Queue)

    def __post_init__(self) -> None:
        """Attach to the task."""
        self.task.tracer = self._trace

    # Commands

    def run(self, stops_on_entry: bool) -> None:
        """Set whether the task stops at its first line."""
        self._command = "in" if stops_on_entry else "continue"

    def pause(self) -> None:
        """Stop the task at its next line."""
        self._asks_pause = True

    def unpause(self) -> None:
        """Forget that the task is to stop at its next line."""
        self._asks_pause = False

    def resume(self, command: Command) -> None:
        """Continue a stopped task: to the next breakpoint, line, line of the same routine, or out of it, or end."""
        if self.is_stopped:
            self.is_stopped = False
            self._commands.put(command)
        elif command == "end":
            self._command = "end"

    def jump(self, line: int) -> None:
        """Move the program pointer of a stopped task to a line of the routine that it is in.

        Raises
        ------
        ValueError
            Where the routine has no statement there.
        """
        assert self._frame is not None
        file = self.task.place_at(self._frame.f_lineno)[0]
        lines = {one for _, _, one in self._frame.f_code.co_lines() if one is not None}
        found = [one for one in sorted(lines) if self.task.place_at(one) == (file, line)]
        if not self.is_stopped or not found:
            raise ValueError(f"the routine has no statement in line {line}")
        self._jump = found[0]
        self.is_stopped = False
        self._commands.put("in")

    def calls(self) -> list[Call]:
        """Return the calls of a stopped task, the innermost first."""
        found, frame = [], self._frame
        while frame is not None:
            if frame.f_code.co_filename == FILE and frame.f_code.co_name != "<lambda>":
                file, line = self.task.place_at(frame.f_lineno)
                routine = self.task.routine_at(file, line)
                name = routine.name.text if routine is not None else ""
                found.append(Call(frame, file, line, name, frame.f_code.co_name == "_handler"))
            frame = frame.f_back
        return found

    def top(self) -> Call:
        """Return the innermost call of the task."""
        return self.calls()[0]

    # Tracing

    def _trace(self, frame: FrameType, event: str, argument: Any) -> Callable[..., Any] | None:
        if frame.f_code.co_filename != FILE:
            return None
        if event == "call":
            self._depth += 1
        elif event == "return":
            self._depth -= 1
            self._places.pop(frame, None)
        elif event == "exception":
            self._on_error(frame, argument[1])
        elif event == "line":
            self._on_line(frame)
        return self._trace

    def _on_error(self, frame: FrameType, error: Any) -> None:
        if not self.stops_at_errors or error is self._error or isinstance(error, ProgramEnd):
            return
        self._error = error
        if isinstance(error, Exception):
            name = f"{error.name}: " if isinstance(error, RapidError) else ""
            self._stop(frame, "exception", f"{name}{error}")

    def _on_line(self, frame: FrameType) -> None:
        place = self.task.place_at(frame.f_lineno)
        if self._command == "end":
            raise ProgramEnd("the debugger")
        if self._places.get(frame) == place:
            return
        self._places[frame] = self.place = place
        reason, text = self._reason_at(frame, place), ""
        while reason:
            self._stop(frame, reason, text)
            if self._jump is None:
                return
            try:
                frame.f_lineno = self._jump  # type: ignore[misc]  # a trace function may
            except ValueError:
                text = "the program pointer does not move into a loop or a branch"
            else:
                text = ""
            self._jump = None
            self._places[frame] = self.place = self.task.place_at(frame.f_lineno)
            reason = "goto"

    def _reason_at(self, frame: FrameType, place: Place) -> str:
        """Return why the task stops at a place, or nothing."""
        if self._asks_pause:
            return "pause"
        file, line = place
        lines = self.breakpoints.get(str(Path(file).resolve()), {}) if self.breakpoints else {}
        if line in lines and ((condition := lines[line]) is None or self._holds(condition, frame)):
            return "breakpoint"
        limit = {"in": 10**9, "over": self._start, "out": self._start - 1}.get(self._command, -1)
        return self._reason if self._depth <= limit else ""

    def _holds(self, condition: Callable[[], bool], frame: FrameType) -> bool:
        """Return whether a condition holds; one that cannot be worked out does."""
        self._frame = frame
        try:
            return condition()
        except (ValueError, RapidError):
            return True
        finally:
            self._frame = None

    def _stop(self, frame: FrameType, reason: str, text: str = "") -> None:
        self._frame, self._asks_pause, self._reason = frame, False, "step"
        self.is_stopped = True
        with self.task.waiting():
            self.on_stop(reason, text)
            self._command = self._commands.get()
        self._start = self._depth
        self._frame = None
        if self._command == "end":
            raise ProgramEnd("the debugger")
