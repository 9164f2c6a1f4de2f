"""A task: the modules of a program, loaded and ready to run."""

from __future__ import annotations

import contextlib
import functools
import math
import re
import socket
import sys
import weakref
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from types import FrameType, TracebackType
from typing import IO, TYPE_CHECKING, Any

from daidalos.common.suggestions import hint
from daidalos.industry.rapid import flow, predefined, tree
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.expressions import ExpressionChecker
from daidalos.industry.rapid.parsing import Parsed
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.runtime import arithmetic
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.errors import (
    RECOVERABLE,
    FatalError,
    Jump,
    ProgramEnd,
    RapidError,
    as_rapid_error,
    error_name,
)
from daidalos.industry.rapid.runtime.expressions import ExpressionTranslator
from daidalos.industry.rapid.runtime.interrupts import Interrupts
from daidalos.industry.rapid.runtime.names import global_name, python_name
from daidalos.industry.rapid.runtime.pendant import Pendant, TextPendant
from daidalos.industry.rapid.runtime.registry import is_timed, routines
from daidalos.industry.rapid.runtime.robot import Robot, SimpleRobot
from daidalos.industry.rapid.runtime.translation import FILE, Translation, translate
from daidalos.industry.rapid.runtime.values import copied, counted, default_value, index_of, is_scalar
from daidalos.industry.rapid.symbols import DataSymbol, Owned, RoutineSymbol, Type
from daidalos.industry.rapid.types import TypeTable

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.cell import Cell

MAX_RETRIES = 4
STOPPED_POLL = 0.05
"""Seconds between two looks at whether a stopped robot was started."""

RETRY, TRYNEXT = "RETRY", "TRYNEXT"
EPOCH = datetime(2000, 1, 1)


@dataclass
class Outcome:
    """How a run ended.

    Attributes
    ----------
    reason
        ``end``, ``EXIT``, ``Stop``, ``ExitCycle``, ``error`` or ``interrupted``.
    message
        What has happened, with ``file:line``, where it was an error.
    time
        Robot time in seconds.
    """

    reason: str
    message: str = ""
    time: float = 0.0
    calls: list[str] = field(default_factory=list)


class Task:
    """A program with its data, its signals and its robot.

    Parameters
    ----------
    modules
        Modules without errors.
    checker
        Checker of them, after `Checker.check`.
    robot
        What carries out movements.
    board
        The signals.
    pendant
        The operator's screen.
    pace
        Called with each span of robot time in seconds before the program goes on, to let as much real time pass.
    now
        Date and time when the run begins.
    home
        Folder that files of the program are below; without it, the present one.
    limit
        Robot time in seconds after which the run ends; None for none.
    is_debugged
        Whether all local data is kept so that a debugger can change it.
    """

    def __init__(
        self,
        modules: Sequence[Parsed],
        checker: Checker,
        robot: Robot | None = None,
        board: Board | None = None,
        pendant: Pendant | None = None,
        pace: Callable[[float], None] | None = None,
        now: datetime = EPOCH,
        home: Path | None = None,
        limit: float | None = None,
        is_debugged: bool = False,
    ) -> None:
        self.modules = modules
        self.robot: Robot = robot if robot is not None else SimpleRobot()
        self.signals = board if board is not None else Board()
        self.pendant: Pendant = pendant if pendant is not None else TextPendant()
        self.interrupts = Interrupts(self)
        self.now = now
        self.home = home if home is not None else Path()
        self.resources: list[IO[Any] | socket.socket] = []
        """Files and sockets that the end of a run closes."""
        self.time = 0.0
        self._limit = limit
        self.progress = 0
        """Counts whatever lets time pass or is seen from outside, so that a loop without any of it can be named."""
        self.is_waiting = False
        """Whether real time passes just now, or the operator is asked."""
        self.errno = 0.0
        self.remaining_retries = float(MAX_RETRIES)
        self.resets_retries = False
        self._forgiven: weakref.WeakKeyDictionary[Callable[[], Any], int] = weakref.WeakKeyDictionary()
        self.intno = 0.0
        self.settings: dict[str, Any] = {}
        self.tracer: Callable[..., Any] | None = None
        """Trace function of Python that runs with the program."""
        self.name = "T_ROB1"
        self.cell: Cell | None = None
        """The tasks that run at the same time."""
        self._pace = pace
        self._checker = checker
        self._translation: Translation = translate(modules, checker, is_debugged)
        self._types = checker.type_table(checker.task)
        self._namespace = self._make_namespace()
        exec(compile(self._translation.text(), FILE, "exec"), self._namespace)
        self._load_data()

    # Running

    def run(self, name: str = "main") -> Outcome:
        """Run a procedure without arguments to its end."""
        owned = next((one for one in self._routines() if one.name.key == name.lower()), None)
        if owned is None or not isinstance(owned.symbol, RoutineSymbol) or owned.symbol.kind != "PROC":
            known = [one.symbol.name for one in self._routines() if one.symbol.kind == "PROC"]
            return Outcome("error", f"there is no procedure '{name}'{hint(name, known)}")
        try:
            outcome = self._run(self._namespace[global_name(owned)])
            self.robot.advance(self.robot.stop())
            return outcome
        finally:
            for resource in self.resources:
                resource.close()
            self.resources.clear()

    def reset(self) -> None:
        """Give variables their initial values, and forget interrupts; persistents keep theirs, as on a controller."""
        kept = [(global_name(owned), value) for owned, _, value in self.persistents()]
        self._load_data()
        for key, value in kept:
            self._namespace[key] = value
        self.interrupts.close()
        self.interrupts = Interrupts(self)

    def _run(self, procedure: Callable[[], Any]) -> Outcome:
        try:
            if self.tracer is not None:
                sys.settrace(self.tracer)
            try:
                procedure()
            finally:
                if self.tracer is not None:
                    sys.settrace(None)
            self.wait_for_robot(self.robot.remaining)
        except ProgramEnd as end:
            return Outcome(end.reason, "" if end.reason == "EXIT" else self._where(end), self.time)
        except KeyboardInterrupt as error:
            return Outcome("interrupted", f"{self._where(error)}: interrupted", self.time, self._calls(error))
        except FatalError as error:
            return Outcome("error", f"{self._where(error)}: {error}", self.time, self._calls(error))
        except RecursionError as error:
            message = f"{self._where(error)}: a routine calls itself too often"
            return Outcome("error", message, self.time, self._calls(error)[:3])
        except (*RECOVERABLE, TypeError, ValueError, AttributeError, KeyError) as error:
            known_error = as_rapid_error(error)
            message = f"{self._where(error)}: {known_error.name}: {known_error.message}"
            return Outcome("error", message, self.time, self._calls(error))
        return Outcome("end", "", self.time)

    def pass_time(self, seconds: float, is_poll: bool = False) -> None:
        """Advance robot time, and run the traps and events that fall due in it.

        A task that polls a condition goes on earlier where another task has changed a signal, or has come to meet it.
        """
        end = self.time + max(seconds, 0.0)
        self.progress += 1
        while True:
            due = self._next_time()
            is_last = due is None or due > end
            self._advance(end if due is None else min(due, end))
            self._serve()
            if (is_last and self.time >= end) or (is_poll and self.time < end and self.cell is not None):
                return

    def _next_time(self) -> float | None:
        event = self.robot.next_event()
        times = (self.interrupts.next_time(), self.time + event if event is not None else None)
        return min((one for one in times if one is not None), default=None)

    def _serve(self) -> None:
        self.robot.serve()
        self.interrupts.serve()

    def wait_for_robot(self, left: Callable[[], float]) -> None:
        """Advance time until a time that a robot says is over; while the robot is stopped, until a trap starts it.

        Raises
        ------
        FatalError
            Where the robot is stopped, and nothing is left that could start it.
        """
        if self.cell is not None:
            self.cell.is_active(self)
        while (seconds := left()) > 0.0:
            if math.isinf(seconds):
                self.expect_change("the movement is stopped, and nothing is left that could start it; use StartMove")
                seconds = STOPPED_POLL
            self.pass_time(seconds)

    def expect_change(self, what: str) -> None:
        """Check that timers, the world outside or another task can change what the task waits for.

        Raises
        ------
        FatalError
            Where there is none of them; with the message.
        """
        if self.interrupts.next_time() is not None or self.settings.get("is_live"):
            return
        if self.cell is None or not self.cell.can_change(self):
            raise FatalError(what)

    def catch_up(self) -> None:
        """Advance time until instructions run that come behind the latest movement; a trap does not wait."""
        if not self.interrupts.is_serving:
            self.wait_for_robot(self.robot.lead)

    def signal(self, name: object) -> float:
        """Return the value that a signal has when the program reads it."""
        self.catch_up()
        return self.signals.value(name)

    def _advance(self, time: float) -> None:
        if self._limit is not None and time > self._limit:
            self.time = self._limit
            raise ProgramEnd("its time limit")
        if time <= self.time:
            return
        if self.cell is not None:
            time = self.cell.sleep(self, time)
        elif self._pace is not None:
            self.is_waiting = True
            self._pace(time - self.time)
            self.is_waiting = False
        with self.waiting():
            self.robot.advance(time - self.time)
        self.time = time

    def ask(self, text: str, choices: Sequence[str] = ()) -> str:
        """Return what the operator answers."""
        with self.waiting():
            return self.pendant.ask(text, choices)

    @contextlib.contextmanager
    def waiting(self) -> Iterator[None]:
        """Mark that the program waits for someone else, or for the plan of a movement."""
        before, self.is_waiting = self.is_waiting, True
        try:
            yield
        finally:
            self.is_waiting = before

    # Called by the translated program

    def recover(self, error: Exception, tries: int, handler: Callable[[], Any], numbers: tuple[float, ...]) -> Any:
        """Run the error handler of a routine, and return what it wants: RETRY, TRYNEXT or a value to return."""
        known = as_rapid_error(error)
        is_listed = bool(numbers) and (known.number in numbers or -999.0 in numbers)
        if _is_from_callee(error) and not known.is_propagated and not is_listed:
            raise error
        if numbers and not is_listed:
            raise error
        tries -= self._forgiven.get(handler, 0)
        self.remaining_retries = float(max(MAX_RETRIES - tries, 0))
        if tries > MAX_RETRIES:
            raise FatalError(f"ERR_EXCRTYMAX: RETRY more than {MAX_RETRIES} times after {known.name}: {known.message}")
        known.is_propagated = False
        self.errno = known.number
        self.progress += 1
        self.resets_retries = False
        action = handler()
        if self.resets_retries:
            self._forgiven[handler] = self._forgiven.get(handler, 0) + tries + 1
        if action is None:
            raise FatalError(
                f"{known.name}: {known.message}; its error handler ends without RETRY, TRYNEXT, RETURN or RAISE"
            )
        return action

    def is_undone(self, left: Exception) -> bool:
        """Return whether the UNDO handler runs of a routine that is left so: not at the end of the whole program."""
        return not isinstance(left, ProgramEnd) or left.reason == "ExitCycle"

    def raise_(self, number: float | None, in_handler: bool) -> None:
        """Raise an error, or hand the present one on to the caller."""
        value = self.errno if number is None else number
        error = RapidError(value, f"error {error_name(value)} was raised")
        error.is_propagated = in_handler
        raise error

    def call_late(self, name: str, arguments: list[tuple[str | None, bool, Any, Any]]) -> None:
        """Call the procedure that a string names."""
        key = name.split(":")[-1].lower()
        owned = next((one for one in self._routines() if one.name.key == key), None)
        symbol = owned.symbol if owned is not None else None
        if owned is None or not isinstance(symbol, RoutineSymbol) or symbol.kind != "PROC" or symbol.node is None:
            raise RapidError("ERR_REFUNKPRC", f"there is no procedure '{name}'")
        required = [one for group in symbol.node.groups if not group.is_optional for one in group.alternatives]
        optional = {one.name.key: one for one in symbol.node.parameters()}
        positional = iter(required)
        given: dict[str, Any] = {}
        for argument, is_optional, value, reference in arguments:
            parameter = optional.get(argument or "") if is_optional else next(positional, None)
            if not isinstance(parameter, tree.Parameter):
                raise RapidError("ERR_CALLPROC", f"an argument too many for '{name}'")
            by_reference = parameter.mode and isinstance(reference, tuple | list)
            given[f"a_{python_name(parameter.name.key)}"] = reference if by_reference else value
        if next(positional, None) is not None:
            raise RapidError("ERR_CALLPROC", f"an argument is missing for '{name}'")
        self._namespace[global_name(owned)](**given)

    def connect(self, target: Any, trap: Callable[[], Any]) -> None:
        """Connect an interrupt to a trap."""
        target[0][target[1]] = self.interrupts.connect(trap)

    def default(self, type_: str, sizes: list[int]) -> Any:
        """Return the value of data that was declared without one."""
        return default_value(self._types, Type(type_), sizes)

    def unknown(self, name: str) -> None:
        """Stop the program at an instruction that only a controller has."""
        raise FatalError(f"'{name}' runs on a controller only")

    def no_return(self, name: str) -> None:
        """Stop a function that ends without a result."""
        raise FatalError(f"the function '{name}' has ended without RETURN")

    def line(self) -> str:
        """Return ``file:line`` of the statement that is being run."""
        return self.place_of_frame(sys._getframe(1))

    def place_of_frame(self, frame: FrameType | None) -> str:
        """Return ``file:line`` of the innermost routine of the program below a frame of Python, or nothing."""
        while frame is not None and frame.f_code.co_filename != FILE:
            frame = frame.f_back
        return self.place_of(frame.f_lineno) if frame is not None else ""

    def place_at(self, line: int) -> tuple[str, int]:
        """Return the file and the line of a line of the translated program."""
        return self._translation.places[line - 1]

    def lines_with_code(self, file: str) -> set[int]:
        """Return the lines of a file in which a statement begins."""
        sources = [one for one in self.modules if one.source.file == file]
        routines = (
            (parsed, one)
            for parsed in sources
            for module in parsed.tree.modules
            for one in module.items
            if isinstance(one, tree.Routine)
        )
        return {
            parsed.source.place(node.start)[0]
            for parsed, routine in routines
            for node in flow.statements([*routine.body, *(one for handler in routine.handlers for one in handler.body)])
            if not isinstance(node, tree.Data | tree.Label)
        }

    def routine_at(self, file: str, line: int) -> tree.Routine | None:
        """Return the routine that a line of a file is in."""
        for parsed in self.modules:
            if parsed.source.file != file:
                continue
            start, end = parsed.source.offset(line, 1), parsed.source.offset(line + 1, 1)
            items = (item for module in parsed.tree.modules for item in module.items)
            return next(
                (one for one in items if isinstance(one, tree.Routine) and one.start < end and one.end > start), None
            )
        return None

    # Data

    @property
    def types(self) -> TypeTable:
        """Return the data types that the program knows."""
        return self._types

    @property
    def store(self) -> dict[str, Any]:
        """Return the values of all data of modules by the names of the translated program."""
        return self._namespace

    def stored_data(self) -> list[tuple[str, DataSymbol, str]]:
        """Return all data of modules, each with its module and the name of its value in `store`."""
        found = ((one, one.symbol) for one in self._owned())
        return [(one.module, symbol, global_name(one)) for one, symbol in found if isinstance(symbol, DataSymbol)]

    def is_scalar(self, type_: Type) -> bool:
        """Return whether values of a type are single ones."""
        return is_scalar(self._types, type_)

    def read(self, key: str) -> Any:
        """Return the value of data by its name in the translated program."""
        return self._namespace[key]

    def write(self, key: str, value: Any) -> None:
        """Replace the value of data by its name in the translated program."""
        self._namespace[key] = value

    def value(self, name: str) -> Any:
        """Return the value of data of a module by its name."""
        return self._namespace[global_name(self.data(name))]

    def set_value(self, name: str, value: Any) -> None:
        """Assign to data of a module by its name."""
        key = global_name(self.data(name))
        if isinstance(value, list):
            self._namespace[key][:] = copied(value)
        else:
            self._namespace[key] = value

    def data(self, name: str) -> Owned:
        """Return the declaration of data of a module.

        Raises
        ------
        RapidError
            ERR_SYM_ACCESS
        """
        found = self._checker.task.find(name.lower())
        if found is None:
            scopes = self._checker.locals.values()
            found = next((scope.names[name.lower()] for scope in scopes if name.lower() in scope.names), None)
        if found is None or not isinstance(found.symbol, DataSymbol):
            raise RapidError("ERR_SYM_ACCESS", f"there is no data '{name}'")
        return found

    def persistents(self) -> list[tuple[Owned, tree.Data, Any]]:
        """Return all persistents with their present values."""
        return [
            (owned, owned.symbol.node, self._namespace[global_name(owned)])
            for owned in self._owned()
            if isinstance(owned.symbol, DataSymbol)
            and owned.symbol.kind == "PERS"
            and isinstance(owned.symbol.node, tree.Data)
        ]

    def _owned(self) -> list[Owned]:
        scopes = [self._checker.task, *self._checker.locals.values()]
        return [owned for scope in scopes for owned in scope.names.values()]

    def _routines(self) -> list[Owned]:
        return [one for one in self._owned() if isinstance(one.symbol, RoutineSymbol)]

    def _make_namespace(self) -> dict[str, Any]:
        namespace: dict[str, Any] = {
            "_task": self,
            "_copied": copied,
            "_counted": counted,
            "_index": index_of,
            "_RECOVERABLE": RECOVERABLE,
            "_RETRY": RETRY,
            "_TRYNEXT": TRYNEXT,
            "_Jump": Jump,
            "_ProgramEnd": ProgramEnd,
            **arithmetic.OPERATIONS,
            **self._translation.constants,
            **{f"b_{name}": _timed(function) if is_timed(name) else function for name, function in routines().items()},
        }
        namespace["_G"] = namespace
        for key in set(re.findall(r"\bp_(\w+)", self._translation.text())):
            namespace[f"p_{key}"] = self._predefined(key)
        return namespace

    def _predefined(self, key: str) -> Any:
        from daidalos.industry.rapid.literals import parse_literals

        symbol = predefined.find(key)
        assert isinstance(symbol, DataSymbol)
        if not symbol.value:
            return default_value(self._types, symbol.type, [])
        return copied(parse_literals(f"[{symbol.value}]")[0])

    def _load_data(self) -> None:
        """Give data of modules their initial values; constants of others are known before what is made of them."""
        waiting = [
            (parsed, module, one) for parsed in self.modules for module in parsed.tree.modules for one in module.items
        ]
        pending = [(parsed, module, one) for parsed, module, one in waiting if isinstance(one, tree.Data)]
        while pending:
            later = [one for one in pending if not self._load_one(*one)]
            if len(later) == len(pending):
                parsed, _, node = later[0]
                line = parsed.source.place(node.start)[0]
                raise FatalError(f"{parsed.source.file}:{line}: the value of '{node.name.text}' depends on itself")
            pending = later

    def _load_one(self, parsed: Parsed, module: tree.Module, node: tree.Data) -> bool:
        scope = self._checker.locals[id(module)]
        types: TypeTable = self._checker.type_table(scope)
        owned = scope.find(node.name.key)
        assert owned is not None
        checker = ExpressionChecker(types, Reporter(parsed.source), set(), lambda *_: None)
        checker.scope = scope
        constants: dict[str, Any] = {}

        def constant(value: Any) -> str:
            constants[f"k_{len(constants)}"] = value
            return f"k_{len(constants) - 1}"

        translator = ExpressionTranslator(checker, constant)
        try:
            if node.value is not None:
                value = self._evaluate(translator.copy(node.value), constants)
            else:
                sizes = [int(self._evaluate(translator.read(one), constants)) for one in node.dimensions]
                value = default_value(types, Type(node.type.key), sizes)
        except NameError:
            return False
        except (*RECOVERABLE, TypeError, ValueError) as error:
            line = parsed.source.place(node.start)[0]
            message = as_rapid_error(error).message
            raise FatalError(f"{parsed.source.file}:{line}: the value of '{node.name.text}': {message}") from None
        self._namespace[global_name(owned)] = value
        return True

    def _evaluate(self, text: str, constants: dict[str, Any]) -> Any:
        for key in set(re.findall(r"\bp_(\w+)", text)):
            self._namespace.setdefault(f"p_{key}", self._predefined(key))
        return eval(text, self._namespace, constants)

    # Places

    def place_of(self, line: int) -> str:
        """Return ``file:line`` of a line of the translated program."""
        file, number = self._translation.places[line - 1]
        return f"{file}:{number}"

    def _where(self, error: BaseException) -> str:
        calls = self._calls(error)
        return calls[0] if calls else self._translation.places[0][0]

    def _calls(self, error: BaseException) -> list[str]:
        """Return the places of the routines that an error has come through, the innermost first."""
        return [self.place_of(line) for line in reversed(_lines(error.__traceback__))]


def _timed(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a routine that runs when the robot has come as far as the program has."""

    @functools.wraps(function)
    def run(task: Task, *values: Any, **named: Any) -> Any:
        task.catch_up()
        return function(task, *values, **named)

    return run


def _lines(traceback: TracebackType | None) -> list[int]:
    """Return the lines of the translated program in a traceback, one per call of a routine, the outermost first."""
    found: dict[FrameType, int] = {}
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == FILE:
            found[traceback.tb_frame] = traceback.tb_lineno
        traceback = traceback.tb_next
    return list(found.values())


def _is_from_callee(error: BaseException) -> bool:
    return len(_lines(error.__traceback__)) > 1
