"""Programs under test: nodes and launch files, which can be killed and started again."""

from __future__ import annotations

import os
import re
import signal
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint
from daidalos.lockstep.programs import Program
from daidalos.lockstep.run import Run
from daidalos.testing.scenario import Scenario, ScenarioFailure

if TYPE_CHECKING:
    from rclpy.node import Node

_START_S = 30.0


class ScenarioRun(Run):
    """Run that remembers how its programs were started."""

    def __init__(self, seed: int = 0) -> None:
        super().__init__(seed)
        self._recipes: dict[int, tuple[Callable[[], Any], Sequence[str], dict[str, Any]]] = {}

    def create(self, body: Callable[[], Any], argv: Sequence[str], **options: Any) -> Program:
        """Return a new program; see `Program`."""
        program = super().create(body, argv, **options)
        options.setdefault("environ", dict(os.environ))
        options.setdefault("folder", os.getcwd())
        self._recipes[id(program)] = (body, list(argv), options)
        return program

    def create_again(self, program: Program) -> Program:
        """Return a new program that is started as another one was."""
        body, argv, options = self._recipes[id(program)]
        return self.create(body, argv, **options)

    def arguments(self, program: Program) -> Sequence[str]:
        """Return the arguments that a program was started with."""
        return self._recipes[id(program)][1]


class Output:
    """Output of a program: passed on to that of the test, and kept line by line.

    Parameters
    ----------
    scenario : Scenario

    Attributes
    ----------
    lines : list of str
        Whole lines so far.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.lines: list[str] = []
        self._scenario = scenario
        self._streams = {1: sys.stdout, 2: sys.stderr}  # those of the test; a program has its own
        self._begun = {1: b"", 2: b""}

    def __call__(self, fd: int, data: bytes) -> None:
        """Take what the program writes."""
        *lines, self._begun[fd] = (self._begun[fd] + data).split(b"\n")
        for line in lines:
            text = line.decode(errors="replace")
            self.lines.append(text)
            self._streams[fd].write(f"{text}\n")
        self._scenario.notify()


class RunningNode:
    """Program with a node, as a test handles it.

    Parameters
    ----------
    scenario : Scenario
    program : Program
    output : Output, optional
        None for a program that something else has started.
    """

    def __init__(self, scenario: Scenario, program: Program, output: Output | None = None) -> None:
        self.program = program
        self._scenario = scenario
        self._output = output

    @property
    def is_alive(self) -> bool:
        """Whether it runs."""
        return self.program.status is None

    @property
    def lines(self) -> list[str]:
        """Whole lines that it has printed so far; none of a program that a launch file has started."""
        return [] if self._output is None else list(self._output.lines)

    def kill(self) -> None:
        """End it as SIGKILL does."""
        self._end(getattr(signal, "SIGKILL", 9))

    def interrupt(self) -> None:
        """End it as Ctrl-C does."""
        self._end(signal.SIGINT)

    def restart(self) -> None:
        """Start it again as it was started before; it is killed first where it runs."""
        if self.is_alive:
            self.kill()
        run: Any = self._scenario.run
        self.program = run.create_again(self.program)
        self.program.start()

    def exits(self, within: float) -> int:
        """Require that it ends within some time [s]; return its exit status.

        Raises
        ------
        ScenarioFailure
        """
        __tracebackhide__ = True
        self.program.on_exit.append(lambda status: self._scenario.notify())
        if not self._scenario.wait(lambda: not self.is_alive, within):
            raise ScenarioFailure(f"'{self.program.name}' has not ended within {within:g} s")
        return self.program.status or 0

    def prints(self, pattern: str, within: float) -> str:
        """Require that it prints, or has printed, a line with a regular expression; return the line.

        Raises
        ------
        ScenarioFailure
            With its last lines.
        UserError
            For a program that a launch file has started; its launch prints what it prints.
        """
        __tracebackhide__ = True
        if self._output is None:
            raise UserError(f"the output of '{self.program.name}' is that of its launch")
        lines = self._output.lines

        def found() -> str | None:
            return next((line for line in lines if re.search(pattern, line)), None)

        if not self._scenario.wait(lambda: found() is not None, within):
            last = "".join(f"\n  {line}" for line in lines[-10:])
            raise ScenarioFailure(f"'{self.program.name}' has not printed {pattern!r} within {within:g} s{last}")
        return found() or ""

    def _end(self, number: int) -> None:
        self._scenario.has_ended_programs = True
        ended = threading.Event()
        self.program.on_exit.append(lambda status: ended.set())
        self.program.send_signal(number)
        ended.wait(_START_S)


class Nodes:
    """Programs under test.

    Parameters
    ----------
    scenario : Scenario

    Attributes
    ----------
    started : dict of RunningNode
        Those that were asked for, by name.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self.started: dict[str, RunningNode] = {}

    def run(
        self,
        package: str,
        executable: str,
        *arguments: str,
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | str | Path | None = None,
        remap: Mapping[str, str] | None = None,
        use_sim_time: bool | None = None,
    ) -> RunningNode:
        """Start an executable of a package, as ``ros2 run`` does.

        Parameters
        ----------
        package, executable : str
        *arguments : str
            Of its command line.
        name, namespace : str
            Of its node; its own where empty.
        parameters : mapping or path, optional
            Values by name, or a YAML file.
        remap : mapping, optional
            New names of topics and services by the old ones.
        use_sim_time : bool, optional
            Whether it takes the time from ``/clock``.
        """
        import json

        ros: list[str] = []
        if name:
            ros += ["-r", f"__node:={name}"]
        if namespace:
            ros += ["-r", f"__ns:=/{namespace.strip('/')}"]
        for old, new in (remap or {}).items():
            ros += ["-r", f"{old}:={new}"]
        if isinstance(parameters, str | Path):
            ros += ["--params-file", str(parameters)]
        else:
            for key, value in (parameters or {}).items():
                ros += ["-p", f"{key}:={value if isinstance(value, str) else json.dumps(value)}"]
        if use_sim_time is not None:
            ros += ["-p", f"use_sim_time:={str(use_sim_time).lower()}"]
        command = ["ros2", "run", package, executable, *arguments, *(["--ros-args", *ros] if ros else [])]
        return self._start(name or executable, command)

    def command(self, *words: str) -> RunningNode:
        """Start a command line, such as ``ros2 topic echo /chatter``."""
        return self._start(" ".join(words), list(words))

    def script(self, path: str | Path, *arguments: str) -> RunningNode:
        """Start a Python file."""
        return self._start(Path(path).stem, [sys.executable, str(path), *arguments])

    def add(self, make: Callable[[], Node], threads: int = 1) -> Node:
        """Create a node by a class or function of no arguments in a program of its own, spin it, and return it.

        Raises
        ------
        ScenarioFailure
            When it ends instead.
        """
        __tracebackhide__ = True
        made: list[Node] = []

        def body() -> None:
            import rclpy
            from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

            rclpy.init(args=[])
            node = make()
            made.append(node)
            self._scenario.notify()
            executor = MultiThreadedExecutor(threads) if threads > 1 else SingleThreadedExecutor()
            executor.add_node(node)
            executor.spin()

        program = self._scenario.run.create(body, [getattr(make, "__name__", "node")])
        program.on_exit.append(lambda status: self._scenario.notify())
        program.start()
        self._scenario.wait(lambda: bool(made) or program.status is not None, _START_S)
        if not made:
            raise ScenarioFailure(f"the node '{program.name}' was not created; its output says why")
        self._keep(made[0].get_name(), program)
        return made[0]

    def launch(self, *words: str | Path, **arguments: object) -> RunningNode:
        """Launch a file, as ``ros2 launch`` does; the test fails when that fails before the test has ended a program.

        Parameters
        ----------
        *words : str or Path
            A package and a file in it, or a path.
        **arguments
            Of the launch.
        """
        pairs = [f"{name}:={_launch_text(value)}" for name, value in arguments.items()]
        command = ["ros2", "launch", *map(str, words), *pairs]
        name = Path(str(words[-1])).name
        node = self._start(name, command)

        def on_exit(status: int) -> None:
            scenario = self._scenario
            if status and not scenario.has_ended and not scenario.has_ended_programs:
                last = "".join(f"\n  {line}" for line in node.lines[-3:])
                scenario.fail(f"the launch of '{name}' ended with exit status {status}{last}")

        node.program.on_exit.append(on_exit)
        return node

    def __getitem__(self, name: str) -> RunningNode:
        """Return a program by the name of its node, its executable or its launch file, started by whomever.

        Raises
        ------
        UserError
            With similar names.
        """
        run: Any = self._scenario.run
        if name in self.started:
            return self.started[name]
        names: dict[str, Program] = {}
        for program in self._scenario.run.programs:
            for known in _names_of(program, run.arguments(program)):
                names[known] = program
        if name not in names:
            raise UserError(f"there is no node '{name}'{hint(name, names)}")
        return self._keep(name, names[name])

    def _start(self, name: str, command: list[str]) -> RunningNode:
        output = Output(self._scenario)
        return self._keep(name, self._scenario.start_program(command, on_output=output), output)

    def _keep(self, name: str, program: Program, output: Output | None = None) -> RunningNode:
        node = RunningNode(self._scenario, program, output)
        self.started[name] = node
        return node


def _names_of(program: Program, arguments: Sequence[str]) -> list[str]:
    nodes = [word.partition(":=")[2] for word in arguments if word.startswith("__node:=")]
    return [program.name, Path(program.name).stem, *nodes]


def _launch_text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
