"""Commands in lock-step, as `nodes.terminal.Terminal` runs them in processes.

A test with the mark `scenario` takes the fixture over: `from nodes.stepped_terminal import terminal`.
"""

from __future__ import annotations

import re
from types import TracebackType
from typing import Self

import pytest

from daidalos.testing.programs import Nodes, RunningNode
from daidalos.testing.scenario import Scenario

TIMEOUT_S = 60.0
"""How long [s] of simulated time anything may take that is expected to happen."""


class Terminal:
    """Runs ``ros2 WORDS...`` and ends it when the ``with`` block ends."""

    def __init__(self, nodes: Nodes, scenario: Scenario, *words: str) -> None:
        self._scenario = scenario
        self._node: RunningNode = nodes.command("ros2", *words)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None and self._node.is_alive:
            self._node.kill()

    @property
    def lines(self) -> list[str]:
        return self._node.lines

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def wait_for(self, pattern: str, count: int = 1) -> list[str]:
        """Return the first lines that a pattern is found in."""

        def found() -> list[str]:
            return [line for line in self.lines if re.search(pattern, line)][:count]

        came = self._scenario.wait(lambda: len(found()) == count, TIMEOUT_S)
        assert came, f"no {count} lines with {pattern!r} in:\n{self.text}"
        return found()

    def interrupt(self) -> int:
        """End it as Ctrl-C does and return the exit status."""
        self._node.interrupt()
        return self.wait()

    def wait(self, timeout_s: float = TIMEOUT_S) -> int:
        """Return the exit status once it has ended and shown no traceback."""
        status = self._node.exits(timeout_s)
        assert "Traceback" not in self.text, self.text
        assert "KeyboardInterrupt" not in self.text, self.text
        return status


class Terminals:
    """Starts commands."""

    def __init__(self, nodes: Nodes, scenario: Scenario) -> None:
        self._nodes, self._scenario = nodes, scenario

    def __call__(self, *words: str) -> Terminal:
        return Terminal(self._nodes, self._scenario, *words)

    def ros2(self, *words: str) -> str:
        """Run a command to its end, which must succeed; return what it showed."""
        with self(*words) as command:
            assert command.wait() == 0, command.text
            return command.text

    def until_shown(self, pattern: str, *words: str) -> str:
        """Run a command that looks once, again and again until it shows what is to be; return what it showed."""
        begun = self._scenario.now
        while not re.search(pattern, shown := self.ros2(*words), re.MULTILINE):
            assert self._scenario.now < begun + TIMEOUT_S, f"{' '.join(words)} never showed {pattern!r}:\n{shown}"
            self._scenario.sleep(0.1)
        return shown


@pytest.fixture
def terminal(nodes: Nodes, scenario: Scenario) -> Terminals:
    """Where commands are given, all in one lock-step run."""
    return Terminals(nodes, scenario)
