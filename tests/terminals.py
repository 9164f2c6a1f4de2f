"""Shells that tests type into as a user would, in one or several terminals."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil

PATIENCE_S = 100.0
_FORGOTTEN = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH", "PYTHONPATH", "COLUMNS", "PYTHONWARNINGS")


def environment(domain: int, home: Path) -> dict[str, str]:
    """Return the environment of someone who has activated the virtual environment, alone in a domain."""
    kept = {name: value for name, value in os.environ.items() if name not in _FORGOTTEN}
    # The tests' own configuration is none of the business of tests that are run by colcon.
    kept.pop("PYTEST_ADDOPTS", None)
    kept.pop("PYTEST_CURRENT_TEST", None)
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
    """One shell.

    Parameters
    ----------
    env
        Its environment at the start.
    cwd
        Its folder at the start.
    shell
        The shell.
    """

    def __init__(self, env: dict[str, str], cwd: Path, shell: str = "bash") -> None:
        self._process = subprocess.Popen(
            [shell], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=env, cwd=cwd
        )
        self._lines: list[str] = []
        self._changed = threading.Condition()
        self._closed = False
        self._count = 0
        self._begin = 0
        self.running = False
        threading.Thread(target=self._read, daemon=True).start()
        # Each command gets a process group of its own, which Ctrl-C can reach.
        self._type("set -m")

    def run(self, command: str, patience_s: float = PATIENCE_S) -> str:
        """Type a command, wait for its end, and return what it printed; `status` has its exit status."""
        self.start(command)
        return self.finish(patience_s)

    def start(self, command: str) -> None:
        """Type a command and do not wait for it."""
        assert not self.running, "something is running in this terminal"
        self._count += 1
        self.running = True
        with self._changed:
            self._begin = len(self._lines)
        self._type(f"{command}\n_status=$?; echo; echo '@@end' {self._count} $_status")

    def finish(self, patience_s: float = PATIENCE_S) -> str:
        """Wait for the end of the command that was started, and return what it printed."""
        mark = re.compile(rf"@@end {self._count} (\d+)")
        line = self._wait_for(mark, patience_s, "the command's end")
        self.status = int(mark.search(line)[1])
        self.running = False
        text = self.output()
        return text[: text.rindex("@@end")].removesuffix("\n")

    def wait_for(self, pattern: str, patience_s: float = PATIENCE_S) -> str:
        """Wait until the running command has printed a line with this pattern; returns the line."""
        return self._wait_for(re.compile(pattern), patience_s, repr(pattern))

    def output(self) -> str:
        """Return what the current command has printed so far."""
        with self._changed:
            return "".join(self._lines[self._begin :])

    def interrupt(self, patience_s: float = PATIENCE_S) -> str:
        """Press Ctrl-C until the running command ends; returns all that it has printed."""
        self._signal(signal.SIGINT)
        return self.finish(patience_s)

    def close(self) -> None:
        """End the shell and all that it has started."""
        children = psutil.Process(self._process.pid).children(recursive=True) if self._process.poll() is None else []
        for child in children:
            _end(child)
        self._process.kill()
        self._process.wait()
        self._process.stdin.close()

    def _signal(self, number: int) -> None:
        for child in psutil.Process(self._process.pid).children():
            os.killpg(child.pid, number)

    def _type(self, text: str) -> None:
        self._process.stdin.write(f"{text}\n".encode())
        self._process.stdin.flush()

    def _read(self) -> None:
        for line in self._process.stdout:
            with self._changed:
                self._lines.append(line.decode(errors="replace"))
                self._changed.notify_all()
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _wait_for(self, pattern: re.Pattern[str], patience_s: float, what: str) -> str:
        end = time.monotonic() + patience_s
        with self._changed:
            seen = self._begin
            while True:
                for line in self._lines[seen:]:
                    if pattern.search(line):
                        return line
                seen = len(self._lines)
                rest = end - time.monotonic()
                if rest <= 0 or self._closed:
                    raise AssertionError(f"waited for {what}; printed:\n{''.join(self._lines[self._begin :])}")
                self._changed.wait(rest)


def _end(process: psutil.Process) -> None:
    try:
        process.kill()
    except psutil.NoSuchProcess:
        return
