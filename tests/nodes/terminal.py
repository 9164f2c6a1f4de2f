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
import threading
import time
from types import TracebackType
from typing import Self

import psutil

PATIENCE_S = 60.0
END_S = 10.0
_NO_SCREEN = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")


class Terminal:
    """Runs ``ros2 WORDS...`` and ends it, with whatever it started, when the ``with`` block ends.

    Attributes
    ----------
    lines : list of str
        What is on the screen so far.
    """

    def __init__(self, *words: str, domain: int, folder: str | os.PathLike[str] | None = None) -> None:
        self.lines: list[str] = []
        self._news = threading.Condition()
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
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

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
        self._reader.join()
        os.close(self._screen)

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def wait_for(self, pattern: str, count: int = 1, after: int = 0) -> list[str]:
        """Return the first lines that a pattern is found in, after as many as were there before."""
        deadline = time.monotonic() + PATIENCE_S
        with self._news:
            while True:
                found = [line for line in self.lines[after:] if re.search(pattern, line)]
                if len(found) >= count:
                    return found[:count]
                left = deadline - time.monotonic()
                ended = self._process.poll() is not None
                if left <= 0 or (not self._news.wait(min(left, 0.5)) and ended):
                    raise AssertionError(f"no {count} lines with {pattern!r} in:\n{self.text}")

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

    def wait(self, patience_s: float = END_S) -> int:
        """Return the exit status once it has ended, having left nothing behind and shown no traceback."""
        try:
            status = self._process.wait(patience_s)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running after {patience_s} s:\n{self.text}") from None
        assert not self._members(), "processes were left behind"
        assert termios.tcgetattr(self._line) == self._before, "the terminal is not as it was"
        with self._news:
            self._news.wait_for(lambda: False, 0.1)  # the screen may be a moment behind
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

    def _read(self) -> None:
        rest = ""
        while True:
            try:
                content = os.read(self._screen, 4096)
            except OSError:
                break
            if not content:
                break
            *lines, rest = (rest + content.decode(errors="replace")).split("\n")
            with self._news:
                self.lines += [line.rstrip("\r") for line in lines]
                self._news.notify_all()


def until_shown(pattern: str, *words: str, domain: int) -> str:
    """Run a command that looks once, again and again until it shows what is to be; returns what it showed."""
    deadline = time.monotonic() + PATIENCE_S
    while True:
        with Terminal(*words, domain=domain) as command:
            command.wait(PATIENCE_S)
            if re.search(pattern, command.text, re.MULTILINE):
                return command.text
            assert time.monotonic() < deadline, f"{' '.join(words)} never showed {pattern!r}:\n{command.text}"


_BECOME = """
import fcntl, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # Ctrl-C is for who has this terminal
from daidalos.cli.ros2 import main
sys.exit(main(sys.argv[1:]))
"""
