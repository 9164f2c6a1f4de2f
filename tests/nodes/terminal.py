"""A program in a terminal of its own: its screen is read line by line, and keys are pressed."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import signal
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Self

import psutil
from rclpy.context import Context
from rclpy.node import Node

from printed import Printed

TIMEOUT_S = 60.0
END_S = 30.0
_NO_SCREEN = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")


class Terminal:
    """Runs ``ros2 WORDS...`` and ends it, with whatever it started, when the ``with`` block ends.

    Attributes
    ----------
    lines : list of str
        What is on the screen so far.
    """

    def __init__(self, *words: str, domain: int, folder: str | os.PathLike[str] | None = None) -> None:
        self._screen, self._line = pty.openpty()
        self._before = termios.tcgetattr(self._line)
        environment = {name: value for name, value in os.environ.items() if name not in _NO_SCREEN}
        environment |= {"ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1", "TERM": "xterm", "COLUMNS": "200"}
        self._process = subprocess.Popen(
            [sys.executable, "-c", _BECOME, *words],
            stdin=self._line,
            stdout=self._line,
            stderr=self._line,
            env=environment,
            cwd=folder,
            start_new_session=True,
        )
        self._printed = Printed(self._read())
        self.lines = self._printed.lines

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for member in self._members():
            with contextlib.suppress(psutil.Error):
                member.kill()
        self._process.wait()
        os.close(self._line)  # the last one of the terminal's far side: the reader sees its end
        self._printed.join()
        os.close(self._screen)

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def wait_for(self, pattern: str, count: int = 1, after: int = 0) -> list[str]:
        """Return the first lines that a pattern is found in, after as many as were there before."""

        def find() -> list[str] | None:
            found = [line for line in self.lines[after:] if re.search(pattern, line)]
            return found[:count] if len(found) >= count else None

        found = self._printed.wait(find, TIMEOUT_S, has_ended=lambda: self._process.poll() is not None)
        assert found is not None, f"no {count} lines with {pattern!r} in:\n{self.text}"
        return found

    def press(self, keys: str) -> None:
        """Press keys, as the terminal sends them."""
        os.write(self._screen, keys.encode())

    def interrupt(self) -> int:
        """Press Ctrl-C and return the exit status."""
        self.press("\x03")
        return self.wait()

    def terminate(self) -> int:
        """Ask to end, as a launch does; returns the exit status."""
        self._process.send_signal(signal.SIGTERM)
        return self.wait()

    def wait(self, timeout_s: float = END_S) -> int:
        """Return the exit status once it has ended, having left nothing behind and shown no traceback."""
        try:
            status = self._process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running after {timeout_s} s:\n{self.text}") from None
        assert not self._members(), "processes were left behind"
        assert termios.tcgetattr(self._line) == self._before, "the terminal is not as it was"
        self._printed.wait(lambda: None, 0.1)  # the screen may be a moment behind
        assert "Traceback" not in self.text, self.text
        assert "KeyboardInterrupt" not in self.text, self.text
        return status

    def _members(self) -> list[psutil.Process]:
        members = []
        for process in psutil.process_iter():
            try:
                if os.getsid(process.pid) == self._process.pid and process.status() != psutil.STATUS_ZOMBIE:
                    members.append(process)
            except (OSError, psutil.Error):
                continue
        return members

    def _read(self) -> Iterator[str]:
        rest = ""
        while True:
            try:
                content = os.read(self._screen, 4096)
            except OSError:
                return
            if not content:
                return
            *lines, rest = (rest + content.decode(errors="replace")).split("\n")
            yield from lines


def until_shown(pattern: str, *words: str, domain: int) -> str:
    """Run a command that looks once, again and again until it shows what is to be; returns what it showed."""
    deadline = time.monotonic() + TIMEOUT_S
    while True:
        with Terminal(*words, domain=domain) as command:
            command.wait(TIMEOUT_S)
            if re.search(pattern, command.text, re.MULTILINE):
                return command.text
            assert time.monotonic() < deadline, f"{' '.join(words)} never showed {pattern!r}:\n{command.text}"


def until_node(pattern: str, *, domain: int) -> str:
    """Wait for a node that is not hidden, whose full name has a pattern; return the names of all, a line each."""
    context = Context()
    context.init(args=[], domain_id=domain)
    try:
        watcher = Node("_watcher", context=context, start_parameter_services=False, enable_rosout=False)

        def shown() -> list[str]:
            named = watcher.get_node_names_and_namespaces()
            return sorted(f"{namespace.rstrip('/')}/{name}" for name, namespace in named if not name.startswith("_"))

        is_there = watcher.handle.graph.wait_for(lambda: any(re.search(pattern, one) for one in shown()), TIMEOUT_S)
        assert is_there, f"no node {pattern!r} among {shown()}"
        return "\n".join(shown())
    finally:
        context.shutdown()
        context.destroy()


_BECOME = """
import fcntl, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # Ctrl-C is for who has this terminal
from daidalos.cli.ros2 import main
sys.exit(main(sys.argv[1:]))
"""
