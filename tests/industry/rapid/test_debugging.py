"""The debug adapter, with a client of the protocol: breakpoints, steps, data, the program pointer and bad requests."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

import pytest

from daidalos.cli.daidalos.rapid_debug import _load
from daidalos.industry.rapid.debugging.adapter import Adapter
from daidalos.industry.rapid.debugging.protocol import Channel

PROGRAM = """MODULE debugged
  PERS num total := 10;
  VAR pos place := [1,2,3];
  VAR num list{3} := [7,8,9];
  PROC main()
    VAR num i := 1;
    VAR string word := "a";
    i := i + 1;
    double i;
    FOR k FROM 1 TO 3 DO
      total := total + k;
    ENDFOR
    TPWrite "total " \\Num:=total;
    TPWrite "i " \\Num:=i;
    i := 1 / zero();
    TPWrite word;
  ERROR
    TRYNEXT;
  ENDPROC
  PROC double(INOUT num x)
    VAR num factor := 2;
    x := x * factor;
  ENDPROC
  FUNC num zero()
    RETURN 0;
  ENDFUNC
ENDMODULE
"""


class Client:
    """Client of the Debug Adapter Protocol: sends requests, and reads responses and events in a thread."""

    def __init__(self, read: BinaryIO, write: BinaryIO) -> None:
        self._read, self._write = read, write
        self._count = 0
        self._responses: queue.Queue[dict[str, Any]] = queue.Queue()
        self._events: queue.Queue[dict[str, Any]] = queue.Queue()
        self.output = ""
        threading.Thread(target=self._receive, daemon=True).start()

    def _receive(self) -> None:
        while header := self._read.readline():
            self._read.readline()
            message = json.loads(self._read.read(int(header.split(b":")[1])))
            if message["type"] == "response":
                self._responses.put(message)
            elif message["event"] == "output":
                self.output += message["body"]["output"]
            else:
                self._events.put(message)

    def ask(self, command: str, **arguments: Any) -> dict[str, Any]:
        """Send a request, and return the body of its response, which has to be a success."""
        response = self.response(command, **arguments)
        assert response["success"], response
        return dict(response.get("body") or {})

    def response(self, command: str, **arguments: Any) -> dict[str, Any]:
        """Send a request, and return its response."""
        self._count += 1
        content = json.dumps({"seq": self._count, "type": "request", "command": command, "arguments": arguments})
        self._write.write(f"Content-Length: {len(content)}\r\n\r\n{content}".encode())
        self._write.flush()
        response = self._responses.get(timeout=60)
        assert (response["command"], response["request_seq"]) == (command, self._count)
        return response

    def event(self, name: str) -> dict[str, Any]:
        """Return the body of the next event, which has to have this name."""
        event = self._events.get(timeout=60)
        assert event["event"] == name, event
        return dict(event["body"])

    def start(self, program: Path, *lines: int, **more: Any) -> list[dict[str, Any]]:
        """Launch a program with breakpoints, and return what was said of them."""
        self.ask("initialize", adapterID="rapid")
        self.ask("launch", program=str(program), fast=True, **more)
        self.event("initialized")
        found = self.ask("setBreakpoints", source={"path": str(program)}, breakpoints=[{"line": one} for one in lines])[
            "breakpoints"
        ]
        self.ask("configurationDone")
        return list(found)

    def top(self) -> tuple[str, int]:
        """Return the routine and the line that the program has stopped in."""
        frame = self.ask("stackTrace", threadId=1)["stackFrames"][0]
        return frame["name"], frame["line"]

    def variables(self, scope: str) -> dict[str, dict[str, Any]]:
        """Return the data of a scope of the innermost call by its names."""
        frame = self.ask("stackTrace", threadId=1)["stackFrames"][0]["id"]
        scopes = {one["name"]: one["variablesReference"] for one in self.ask("scopes", frameId=frame)["scopes"]}
        found = self.ask("variables", variablesReference=scopes[scope])["variables"]
        return {one["name"]: {**one, "of": scopes[scope]} for one in found}

    def go(self, command: str) -> tuple[str, int]:
        """Go on, and return where the program stops next."""
        self.ask(command, threadId=1)
        self.event("stopped")
        return self.top()


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "debugged.mod"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def client() -> Iterator[Client]:
    """Return a client of an adapter in this process."""
    to_adapter, from_adapter = os.pipe(), os.pipe()
    channel = Channel(os.fdopen(to_adapter[0], "rb"), os.fdopen(from_adapter[1], "wb"))
    adapter = threading.Thread(target=Adapter(channel, _load).serve, daemon=True)
    adapter.start()
    found = Client(os.fdopen(from_adapter[0], "rb"), os.fdopen(to_adapter[1], "wb"))
    yield found
    found.ask("disconnect")
    adapter.join(10)
    assert not adapter.is_alive()


def test_breakpoints_steps_and_the_stack(client: Client, program: Path) -> None:
    assert client.start(program, 9, 12) == [{"verified": True, "line": 9}, {"verified": True, "line": 13}]
    assert client.event("stopped")["reason"] == "breakpoint"
    assert client.top() == ("main", 9)
    assert client.go("stepIn")[0] == "double"
    assert [one["name"] for one in client.ask("stackTrace", threadId=1)["stackFrames"]] == ["double", "main"]
    assert client.go("stepOut") == ("main", 10)
    assert client.go("next") == ("main", 11)
    assert client.go("continue") == ("main", 13)
    client.ask("continue", threadId=1)
    assert client.event("exited") == {"exitCode": 0}
    client.event("terminated")
    assert client.output.splitlines()[:3] == ["total 16", "i 4", "a"]


def test_step_over_does_not_enter_routines(client: Client, program: Path) -> None:
    client.start(program, 9)
    client.event("stopped")
    assert client.go("next") == ("main", 10)


def test_data_is_seen_and_set(client: Client, program: Path) -> None:
    client.start(program, 9)
    client.event("stopped")
    local = client.variables("Locals")
    assert (local["i"]["value"], local["i"]["type"], local["word"]["value"]) == ("2", "num", '"a"')
    module = client.variables("Module")
    assert module["place"]["value"] == "[1,2,3]"
    parts = client.ask("variables", variablesReference=module["place"]["variablesReference"])["variables"]
    assert [(one["name"], one["value"]) for one in parts] == [("x", "1"), ("y", "2"), ("z", "3")]
    assert client.ask("setVariable", variablesReference=local["i"]["of"], name="i", value="5")["value"] == "5"
    client.ask("setVariable", variablesReference=module["total"]["of"], name="total", value="100")
    client.ask("setVariable", variablesReference=module["place"]["variablesReference"], name="y", value="20")
    frame = client.ask("stackTrace", threadId=1)["stackFrames"][0]["id"]
    for expression, value in (("place.y", "20"), ("list{2}", "8"), ("i", "5"), ("total", "100")):
        assert client.ask("evaluate", expression=expression, frameId=frame)["result"] == value
    assert client.ask("evaluate", expression="list{3} := 33", frameId=frame, context="repl")["result"] == "33"
    client.ask("continue", threadId=1)
    client.event("exited")
    assert client.output.splitlines()[:2] == ["total 106", "i 10"]


@pytest.mark.parametrize("value", ["", "text", "TRUE", '"5"', "[1]", "1+", "__import__('os')"])
def test_a_value_that_does_not_fit_is_refused(client: Client, program: Path, value: str) -> None:
    client.start(program, 9)
    client.event("stopped")
    local = client.variables("Locals")
    response = client.response("setVariable", variablesReference=local["i"]["of"], name="i", value=value)
    assert not response["success"]
    assert "is no value" in response["message"]
    assert client.variables("Locals")["i"]["value"] == "2"


def test_the_program_pointer_is_moved(client: Client, program: Path) -> None:
    client.start(program, 8)
    client.event("stopped")
    client.ask("gotoTargets", source={"path": str(program)}, line=13)
    client.ask("goto", threadId=1, targetId=13)
    assert client.event("stopped")["reason"] == "goto"
    assert client.top() == ("main", 13)
    assert not client.response("goto", threadId=1, targetId=22)["success"]
    client.ask("continue", threadId=1)
    client.event("exited")
    assert client.output.splitlines()[:2] == ["total 10", "i 1"]


def test_stops_at_entry_at_conditions_and_at_errors(client: Client, program: Path) -> None:
    client.start(program, 8, stopOnEntry=True)
    assert client.event("stopped")["reason"] == "entry"
    client.ask("setExceptionBreakpoints", filters=["errors"])
    lines = [{"line": 11, "condition": "total > 11"}, {"line": 13, "condition": "a b c"}]
    client.ask("setBreakpoints", source={"path": str(program)}, breakpoints=lines)
    assert client.go("continue") == ("main", 11)
    assert client.variables("Module")["total"]["value"] == "13"
    client.ask("setBreakpoints", source={"path": str(program)}, breakpoints=[])
    client.ask("continue", threadId=1)
    stopped = client.event("stopped")
    assert (stopped["reason"], client.top()) == ("exception", ("main", 15))
    assert "zero" in stopped["text"]


def test_a_running_program_is_paused_and_ended(client: Client, tmp_path: Path) -> None:
    endless = tmp_path / "endless.mod"
    endless.write_text("MODULE m\nVAR num n;\nPROC main()\nWHILE TRUE DO\nn := n + 1;\nENDWHILE\nENDPROC\nENDMODULE\n")
    client.start(endless)
    client.ask("pause", threadId=1)
    assert client.event("stopped")["reason"] == "pause"
    assert client.top()[1] in (4, 5)
    client.ask("terminate")
    client.event("exited")


def test_the_operator_answers_in_the_console(client: Client, tmp_path: Path) -> None:
    asks = tmp_path / "asks.mod"
    lines = 'VAR num n; TPReadFK n, "go on", "yes", "no", stEmpty, stEmpty, stEmpty; TPWrite "key " \\Num:=n;'
    asks.write_text(f"MODULE m\nPROC main()\n{lines}\nENDPROC\nENDMODULE\n")
    client.start(asks)
    while "answer in the console" not in client.output:
        client.ask("threads")
    assert client.ask("evaluate", expression="no", context="repl") == {"result": "", "variablesReference": 0}
    client.event("exited")
    assert "go on [1] yes  [2] no" in client.output
    assert "key 2" in client.output


@pytest.mark.parametrize(
    ("command", "arguments", "message"),
    [
        ("launch", {}, "launch needs 'program'"),
        ("launch", {"program": "gone.mod"}, "No such file or directory"),
        ("launch", {"program": "gone.mod", "prog": 1}, "launch has no argument 'prog'"),
        ("configurationDone", {}, "launch comes before"),
        ("nonsense", {}, "'nonsense' is no request"),
        ("continue", {"threadId": 7}, "there is no thread 7"),
        ("setBreakpoints", {}, "the arguments of 'setBreakpoints' do not fit"),
    ],
)
def test_requests_that_do_not_fit(client: Client, command: str, arguments: dict[str, Any], message: str) -> None:
    response = client.response(command, **arguments)
    assert not response["success"]
    assert message in response["message"]


@pytest.mark.parametrize(
    "data", [b"nonsense\r\n\r\n", b"Content-Length: x\r\n\r\n", b"Content-Length: 3\r\n\r\nabc", b"X"]
)
def test_bytes_that_are_no_message_end_the_adapter(data: bytes) -> None:
    out = BytesIO()
    Adapter(Channel(BytesIO(data), out), _load).serve()
    assert data == b"X" or b"stderr" in out.getvalue()


@pytest.mark.slow
def test_over_standard_input_and_output_with_two_tasks(tmp_path: Path) -> None:
    for number in (1, 2):
        home = tmp_path / f"TASK{number}"
        home.mkdir()
        (home / f"m{number}.mod").write_text(f'MODULE m\nPROC main()\nTPWrite "task {number}";\nENDPROC\nENDMODULE\n')
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "rapid", "debug"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdin is not None
    assert process.stdout is not None
    client = Client(process.stdout, process.stdin)  # type: ignore[arg-type]
    client.ask("initialize", adapterID="rapid")
    client.ask("launch", program=str(tmp_path), task=["T_ROB1", "T_ROB2"], fast=True)
    client.event("initialized")
    module = tmp_path / "TASK2" / "m2.mod"
    client.ask("setBreakpoints", source={"path": str(module)}, breakpoints=[{"line": 3}])
    client.ask("configurationDone")
    assert client.event("stopped")["threadId"] == 2
    assert [one["name"] for one in client.ask("threads")["threads"]] == ["T_ROB1", "T_ROB2"]
    client.ask("continue", threadId=2)
    client.event("exited")
    client.ask("disconnect")
    assert process.wait(20) == 0
    assert "task 1" in client.output
    assert "task 2" in client.output
