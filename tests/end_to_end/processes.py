"""A command with all the processes that it starts, watched line by line."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import uuid
from types import TracebackType
from typing import Self

import psutil

from printed import Printed

DAIDALOS = [sys.executable, "-m", "daidalos.cli.daidalos"]
ROS2 = [sys.executable, "-m", "daidalos.cli.ros2"]
TIMEOUT_S = 60.0
END_S = 30.0
_MARK = "DAIDALOS_TEST_COMMAND"


class Command:
    """Runs a command in a group of its own; whatever it leaves behind fails the test and is killed.

    Its processes are known by a mark in their environment, whatever group they are in.

    Attributes
    ----------
    lines : list of str
        What it printed so far.
    """

    def __init__(self, *words: str, domain: int) -> None:
        self._mark = uuid.uuid4().hex
        self._process = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=os.environ | {"ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1", _MARK: self._mark},
            start_new_session=True,
        )
        assert self._process.stdout is not None
        self._printed = Printed(self._process.stdout)
        self.lines = self._printed.lines

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for member in self._members():
            member.kill()
        self._process.wait()

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def wait_for_line(self, pattern: str) -> str:
        """Return the first line that a pattern is found in."""
        found = self._printed.wait(
            lambda: next((line for line in self.lines if re.search(pattern, line)), None), TIMEOUT_S
        )
        assert found is not None, f"no line with {pattern!r} in:\n{self.text}"
        return found

    def interrupt(self) -> int:
        """Press Ctrl-C, as a terminal does for the whole group; returns the exit status once all have ended."""
        members = self._members()
        os.killpg(self._process.pid, signal.SIGINT)
        return self._ended(members)

    def send(self, number: int) -> None:
        """Send a signal to the command's own process."""
        self._process.send_signal(number)

    def assert_no_traceback(self) -> None:
        """Check that nothing was printed that only a programmer understands."""
        if "Traceback" in self.text or "KeyboardInterrupt" in self.text:
            raise AssertionError(f"a traceback in:\n{self.text}")

    def _ended(self, members: list[psutil.Process]) -> int:
        ended, alive = psutil.wait_procs(members, END_S)
        names = [" ".join(one.cmdline())[:150] for one in alive]
        assert not alive, f"still running after {END_S} s: {names}, after:\n{self.text}"
        assert not self._members(), "processes were left behind"
        # Where psutil has waited for the command itself, only psutil has its status.
        known = [one.returncode for one in ended if one.pid == self._process.pid and one.returncode is not None]
        status = self._process.wait()
        self._printed.join()
        return known[0] if known else status

    def _members(self) -> list[psutil.Process]:
        """Return the processes that came from the command and have not ended."""
        members = []
        for process in psutil.process_iter():
            try:
                if process.environ().get(_MARK) == self._mark and process.status() != psutil.STATUS_ZOMBIE:
                    members.append(process)
            except psutil.Error:
                continue
        return members


def finished(*words: str, domain: int, timeout: float = 240.0) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    environment = os.environ | {"ROS_DOMAIN_ID": str(domain)}
    return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=timeout)
