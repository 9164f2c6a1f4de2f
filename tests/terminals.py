"""Shells that tests type into as a user would, in one or several terminals."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import threading
import time
from pathlib import Path

import psutil

TIMEOUT_S = 240.0
_ROWS, _COLUMNS = 60, 240
_ESCAPES = re.compile(r"\x1b(?:\[[0-9;?]*[A-Za-z]|\][^\x07]*\x07|[=>])")
_CTRL_C = "\x03"
_FORGOTTEN = {
    "AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLUMNS", "LINES", "PYTEST_ADDOPTS",
    "PYTEST_CURRENT_TEST", "PYTHONDONTWRITEBYTECODE", "PYTHONPATH", "PYTHONWARNINGS",
}  # fmt: skip


def environment(domain: int, home: Path) -> dict[str, str]:
    """Return the environment of someone who has activated the virtual environment, alone in a domain."""
    kept = {name: value for name, value in os.environ.items() if name not in _FORGOTTEN}
    return {
        **kept,
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]),
        "ROS_DOMAIN_ID": str(domain),
        "HOME": str(home),
        "ROS_HOME": str(home / ".ros"),
        "TERM": "dumb",
        "PYTHONUNBUFFERED": "1",
    }


class Terminal:
    """One shell behind a terminal of its own.

    Parameters
    ----------
    env
        Its environment at the start.
    cwd
        Its folder at the start.
    shell
        The command that starts it.
    """

    def __init__(
        self, env: dict[str, str], cwd: Path, shell: tuple[str, ...] = ("bash", "--norc", "--noprofile")
    ) -> None:
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", _ROWS, _COLUMNS, 0, 0))
        self._process = subprocess.Popen(
            [*shell, "-i"], stdin=slave, stdout=slave, stderr=slave, env=env, cwd=cwd, preexec_fn=_take_terminal
        )
        os.close(slave)
        self._text = ""
        self._changed = threading.Condition()
        self._closed = False
        self._count = 0
        self._begin = 0
        self.running = False
        self.status = 0
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        # The shell says of each command that it has ended: nothing may be typed ahead, programs would read it.
        self._type(
            "stty -echo; bind 'set enable-bracketed-paste off' 2>/dev/null; PS1= PS2= _n=-1; "
            """PROMPT_COMMAND='_status=$?; _n=$((_n + 1)); printf "\\n@@end %d %d\\n" $_n $_status'"""
        )
        self._await_end(TIMEOUT_S)

    def run(self, command: str, timeout_s: float = TIMEOUT_S) -> str:
        """Type a command, wait for its end, and return what it printed; `status` has its exit status."""
        self.start(command)
        return self.finish(timeout_s)

    def start(self, command: str) -> None:
        """Type a command and do not wait for it."""
        assert not self.running, "something is running in this terminal"
        self._count += 1
        self.running = True
        self._type(command)

    def finish(self, timeout_s: float = TIMEOUT_S) -> str:
        """Wait for the end of the command that was started, and return what it printed."""
        begin = self._begin
        match = self._await_end(timeout_s)
        self.status = int(match[1])
        self.running = False
        with self._changed:
            return self._text[begin : match.start()]

    def _await_end(self, timeout_s: float) -> re.Match[str]:
        pattern = re.compile(rf"\n?@@end {self._count} (\d+)\n")
        match = self._wait_for(pattern, timeout_s, "the command's end")
        self._begin = match.end()
        return match

    def wait_for(self, pattern: str, timeout_s: float = TIMEOUT_S) -> str:
        """Wait until the running command has printed this pattern; returns what has matched."""
        return self._wait_for(re.compile(pattern), timeout_s, repr(pattern)).group()

    def ended(self) -> bool:
        """Return whether the command that was started has ended."""
        with self._changed:
            return re.search(rf"@@end {self._count} \d+\n", self._text[self._begin :]) is not None

    def output(self) -> str:
        """Return what the current command has printed so far."""
        with self._changed:
            return self._text[self._begin :].split("@@end")[0]

    def wait(self, seconds: float) -> None:
        """Wait until something is printed, but no longer than this."""
        with self._changed:
            self._changed.wait(seconds)

    def press(self, keys: str) -> None:
        """Press keys while a command is running."""
        os.write(self._master, keys.encode())

    def interrupt(self, timeout_s: float = TIMEOUT_S) -> str:
        """Press Ctrl-C, wait for the end of the running command, and return all that it has printed."""
        self.press(_CTRL_C)
        return self.finish(timeout_s)

    def close(self) -> None:
        """End the shell and all that it has started."""
        if self._process.poll() is None:
            for child in psutil.Process(self._process.pid).children(recursive=True):
                _end(child)
        self._process.kill()
        self._process.wait()
        self._reader.join(TIMEOUT_S)
        os.close(self._master)

    def _type(self, text: str) -> None:
        os.write(self._master, f"{text}\n".encode())

    def _read(self) -> None:
        rest = b""
        while True:
            try:
                new = os.read(self._master, 65536)
            except OSError:  # nobody is at the other end any more
                new = b""
            # A line may be cut anywhere, also within a character.
            whole, cut, after = (rest + new).rpartition(b"\n")
            rest = after if new else b""
            with self._changed:
                self._text += _plain(whole + cut if new else rest)
                self._closed = not new
                self._changed.notify_all()
            if not new:
                return

    def _wait_for(self, pattern: re.Pattern[str], timeout_s: float, what: str) -> re.Match[str]:
        end = time.monotonic() + timeout_s
        with self._changed:
            while True:
                match = pattern.search(self._text, self._begin)
                if match:
                    return match
                rest = end - time.monotonic()
                if rest <= 0 or self._closed:
                    raise AssertionError(f"waited for {what}; printed:\n{self._text[self._begin :]}")
                self._changed.wait(rest)


def _take_terminal() -> None:
    """Make the terminal that the new process has at its input the one that controls it."""
    os.setsid()
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def _plain(data: bytes) -> str:
    """Return text as it stays in the terminal: without escapes, and without what was written over."""
    text = _ESCAPES.sub("", data.decode(errors="replace").replace("\r\n", "\n"))
    return re.sub(r"[^\n]*\r", "", text)


def _end(process: psutil.Process) -> None:
    try:
        process.kill()
    except psutil.NoSuchProcess:
        return
