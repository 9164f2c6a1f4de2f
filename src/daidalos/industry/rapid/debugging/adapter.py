"""Debug adapter: the requests of an editor, answered by the debuggers of the tasks of a program."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from daidalos.common.errors import UserError
from daidalos.industry.rapid.debugging.data import Item, condition_of, find, local_data, module_data
from daidalos.industry.rapid.debugging.debugger import Call, Command, Debugger
from daidalos.industry.rapid.debugging.protocol import Channel, Message, ProtocolError
from daidalos.industry.rapid.runtime.cell import Cell
from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.task import Outcome, Task

Load = Callable[[Message], dict[str, Task]]
"""Loads the tasks that the arguments of a launch describe."""

_CAPABILITIES = {
    "supportsConfigurationDoneRequest": True,
    "supportsConditionalBreakpoints": True,
    "supportsSetVariable": True,
    "supportsEvaluateForHovers": True,
    "supportsGotoTargetsRequest": True,
    "supportsTerminateRequest": True,
    "exceptionBreakpointFilters": [{"filter": "errors", "label": "Errors, handled or not", "default": False}],
}


class _RequestError(Exception):
    """Request that cannot be answered; the message says why."""


class EditorPendant:
    """Screen of the operator in an editor: lines go to its console, and answers are typed there."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self.answers: queue.Queue[str | None] = queue.Queue()
        self.is_asking = False

    def write(self, text: str) -> None:
        """Show a line."""
        self._channel.event("output", category="stdout", output=f"{text}\n")

    def erase(self) -> None:
        """Leave the lines: an editor keeps what it has shown."""

    def ask(self, text: str, choices: Sequence[str] = ()) -> str:
        """Return what the operator types in the console."""
        keys = "  ".join(f"[{index}] {one}" for index, one in enumerate(choices, 1) if one)
        self._channel.event("output", category="console", output=f"{text} {keys}\nanswer in the console:\n")
        self.is_asking = True
        answer = self.answers.get()
        self.is_asking = False
        if answer is None:
            raise RapidError("ERR_TP_NO_CLIENT", "nobody answers at the pendant")
        return answer.strip()


class Adapter:
    """Answers the requests of one editor.

    Parameters
    ----------
    channel
        To the editor.
    load
        Loads the tasks; raises UserError.
    """

    def __init__(self, channel: Channel, load: Load) -> None:
        self._channel, self._load = channel, load
        self._pendant = EditorPendant(channel)
        self._debuggers: dict[int, Debugger] = {}
        self._wanted: dict[str, list[Message]] = {}
        self._stops_at_errors = False
        self._references: list[Any] = []
        self._arguments: Message = {}
        self._runner: threading.Thread | None = None
        self._ends = False

    def serve(self) -> None:
        """Answer requests until the editor disconnects."""
        while not self._ends:
            try:
                request = self._channel.receive()
            except ProtocolError as error:
                self._channel.event("output", category="stderr", output=f"{error}\n")
                break
            if request is None:
                break
            self._answer(request)
        self._end()

    def _answer(self, request: Message) -> None:
        command = str(request.get("command", ""))
        method = getattr(self, f"_on_{command.lower()}", None)
        if request.get("type") != "request" or method is None:
            self._channel.respond(request, error=f"'{command}' is no request that is known")
            return
        arguments = request.get("arguments") or {}
        try:
            body = method(arguments)
        except (_RequestError, UserError, ValueError, FatalError) as error:
            self._channel.respond(request, error=str(error))
            return
        except (KeyError, TypeError, IndexError) as error:
            self._channel.respond(request, error=f"the arguments of '{command}' do not fit: {error}")
            return
        self._channel.respond(request, body)
        if command == "launch":
            self._channel.event("initialized")
        elif command == "configurationDone":
            self._start()

    # Beginning and end

    def _on_initialize(self, arguments: Message) -> Message:
        return _CAPABILITIES

    def _on_launch(self, arguments: Message) -> None:
        tasks = self._load(arguments)
        self._arguments = arguments
        for number, task in enumerate(tasks.values(), 1):
            task.pendant = self._pendant
            on_stop = _Stopper(self._channel, number)
            self._debuggers[number] = Debugger(task, on_stop)

    def _on_configurationdone(self, arguments: Message) -> None:
        if not self._debuggers:
            raise _RequestError("launch comes before configurationDone")

    def _start(self) -> None:
        for debugger in self._debuggers.values():
            debugger.run(bool(self._arguments.get("stopOnEntry")))
            debugger.stops_at_errors = self._stops_at_errors
        self._runner = threading.Thread(target=self._run, daemon=True)
        self._runner.start()

    def _run(self) -> None:
        tasks = {one.task.name: one.task for one in self._debuggers.values()}
        procedure = str(self._arguments.get("procedure", "main"))
        outcomes: dict[str, Outcome]
        if len(tasks) == 1:
            name, task = next(iter(tasks.items()))
            outcomes = {name: task.run(procedure)}
        else:
            outcomes = Cell(tasks).run(procedure)
        for name, outcome in outcomes.items():
            text = (
                f"error: {outcome.message}" if outcome.reason == "error" else f"{name} ended after {outcome.time:.3f} s"
            )
            category = "stderr" if outcome.reason == "error" else "console"
            self._channel.event("output", category=category, output=f"{text}\n")
        failed = any(one.reason == "error" for one in outcomes.values())
        self._channel.event("exited", exitCode=2 if failed else 0)
        self._channel.event("terminated")

    def _on_disconnect(self, arguments: Message) -> None:
        self._ends = True

    def _on_terminate(self, arguments: Message) -> None:
        self._end()

    def _end(self) -> None:
        self._pendant.answers.put(None)
        for debugger in self._debuggers.values():
            debugger.resume("end")
        if self._runner is not None:
            self._runner.join(2.0)

    # Breakpoints

    def _on_setbreakpoints(self, arguments: Message) -> Message:
        path = str(Path(arguments["source"]["path"]).resolve())
        found = []
        lines: dict[int, Callable[[], bool] | None] = {}
        for one in arguments.get("breakpoints", []):
            asked = int(one["line"])
            line = self._line_with_code(path, asked)
            if line is None:
                found.append({"verified": False, "line": asked, "message": "no statement is at or behind this line"})
                continue
            found.append({"verified": True, "line": line})
            lines[line] = None
            if one.get("condition"):
                try:
                    lines[line] = self._condition(str(one["condition"]))
                except ValueError as error:
                    found[-1] = {"verified": False, "line": line, "message": str(error)}
                    del lines[line]
        for debugger in self._debuggers.values():
            debugger.breakpoints[path] = lines
        return {"breakpoints": found}

    def _condition(self, text: str) -> Callable[[], bool]:
        debugger = next(iter(self._debuggers.values()))
        condition: Callable[[], bool] = condition_of(debugger.task, text, debugger.top)
        return condition

    def _line_with_code(self, path: str, line: int) -> int | None:
        """Return the first line from one on that has a statement."""
        found = set()
        for debugger in self._debuggers.values():
            for parsed in debugger.task.modules:
                if str(Path(parsed.source.file).resolve()) == path:
                    found |= debugger.task.lines_with_code(parsed.source.file)
        return min((one for one in found if one >= line), default=None)

    def _on_setexceptionbreakpoints(self, arguments: Message) -> None:
        self._stops_at_errors = "errors" in arguments.get("filters", [])
        for debugger in self._debuggers.values():
            debugger.stops_at_errors = self._stops_at_errors

    # Going on

    def _debugger(self, arguments: Message) -> Debugger:
        number = int(arguments.get("threadId", 1))
        if number not in self._debuggers:
            raise _RequestError(f"there is no thread {number}")
        return self._debuggers[number]

    def _go_on(self, arguments: Message, command: Command) -> None:
        debugger = self._debugger(arguments)
        if not debugger.is_stopped:
            raise _RequestError("the task runs; pause it first")
        self._references.clear()
        debugger.resume(command)

    def _on_continue(self, arguments: Message) -> Message:
        self._go_on(arguments, "continue")
        return {"allThreadsContinued": False}

    def _on_next(self, arguments: Message) -> None:
        self._go_on(arguments, "over")

    def _on_stepin(self, arguments: Message) -> None:
        self._go_on(arguments, "in")

    def _on_stepout(self, arguments: Message) -> None:
        self._go_on(arguments, "out")

    def _on_pause(self, arguments: Message) -> None:
        self._debugger(arguments).pause()

    def _on_gototargets(self, arguments: Message) -> Message:
        line = int(arguments["line"])
        return {"targets": [{"id": line, "label": f"line {line}", "line": line}]}

    def _on_goto(self, arguments: Message) -> None:
        self._debugger(arguments).jump(int(arguments["targetId"]))

    # Looking

    def _on_threads(self, arguments: Message) -> Message:
        return {"threads": [{"id": number, "name": one.task.name} for number, one in self._debuggers.items()]}

    def _on_stacktrace(self, arguments: Message) -> Message:
        number = int(arguments.get("threadId", 1))
        calls = self._debugger(arguments).calls() if self._debugger(arguments).is_stopped else []
        frames = [
            {
                "id": number * 1000 + index,
                "name": f"{call.routine} (ERROR)" if call.is_handler else call.routine,
                "line": call.line,
                "column": 1,
                "source": {"name": Path(call.file).name, "path": str(Path(call.file).resolve())},
            }
            for index, call in enumerate(calls)
        ]
        return {"stackFrames": frames, "totalFrames": len(frames)}

    def _call(self, identifier: int) -> tuple[Task, Call]:
        debugger = self._debuggers[identifier // 1000]
        return debugger.task, debugger.calls()[identifier % 1000]

    def _on_scopes(self, arguments: Message) -> Message:
        task, call = self._call(int(arguments["frameId"]))
        local = local_data(task, call)
        everything = list(module_data(task))
        module = next(
            (one.name.key for parsed in task.modules if parsed.source.file == call.file for one in parsed.tree.modules),
            "",
        )
        own = [one for name, one in everything if name.lower() == module]
        others = [one for name, one in everything if name.lower() != module]
        scopes = [("Locals", local), ("Module", own), ("Other modules", others)]
        return {
            "scopes": [
                {"name": name, "variablesReference": self._reference(items), "expensive": name == "Other modules"}
                for name, items in scopes
                if items
            ]
        }

    def _reference(self, items: Any) -> int:
        self._references.append(items)
        return len(self._references)

    def _on_variables(self, arguments: Message) -> Message:
        items: list[Item] = self._references[int(arguments["variablesReference"]) - 1]
        return {"variables": [{"name": one.name, **self._described(one)} for one in items]}

    def _described(self, item: Item) -> Message:
        parts = item.parts()
        return {
            "value": item.text,
            "type": str(item.type),
            "variablesReference": self._reference(parts) if parts else 0,
        }

    def _on_setvariable(self, arguments: Message) -> Message:
        items: list[Item] = self._references[int(arguments["variablesReference"]) - 1]
        item = next((one for one in items if one.name.lower() == str(arguments["name"]).lower()), None)
        if item is None:
            raise _RequestError(f"there is no data '{arguments['name']}'")
        item.set(str(arguments["value"]))
        return self._described(item)

    def _on_evaluate(self, arguments: Message) -> Message:
        text = str(arguments["expression"])
        if self._pendant.is_asking and arguments.get("context") == "repl":
            self._pendant.answers.put(text)
            return {"result": "", "variablesReference": 0}
        if "frameId" not in arguments:
            raise _RequestError("data is seen where a task is stopped")
        task, call = self._call(int(arguments["frameId"]))
        name, assigns, value = text.partition(":=")
        item = find(task, call, name)
        if assigns:
            item.set(value.rstrip("; "))
        described = self._described(item)
        return {"result": described.pop("value"), **described}


class _Stopper:
    """Tells the editor that a task has stopped."""

    def __init__(self, channel: Channel, number: int) -> None:
        self._channel, self._number = channel, number

    def __call__(self, reason: str, text: str) -> None:
        self._channel.event(
            "stopped", reason=reason, threadId=self._number, allThreadsStopped=True, **({"text": text} if text else {})
        )
