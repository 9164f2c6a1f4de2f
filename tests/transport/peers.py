"""Starting other processes for a test and listening to what they say."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Self

PATIENCE_S = 30.0
_SCRIPT = Path(__file__).with_name("peer.py")


class Peer:
    """A process in some role of ``peer.py``, or another script; killed at the end whatever happens.

    Parameters
    ----------
    role
        What it does.
    prefix
        What to start it with, such as ``ip netns exec NAME``.
    script
        Which program has the role.
    environment
        Variables beside the test's own.
    """

    def __init__(self, role: str, *prefix: str, script: Path = _SCRIPT, **environment: str) -> None:
        self.lines: list[str] = []
        self._news = threading.Condition()
        self.process = subprocess.Popen(
            [*prefix, sys.executable, "-P", str(script), role],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=os.environ | environment | {"PYTHONPATH": os.pathsep.join(sys.path)},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.kill()

    def kill(self) -> None:
        """End it as a crash would."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
        self.process.wait()
        self._reader.join()

    def ready(self) -> Self:
        """Wait until it is ready."""
        self.wait_for("ready")
        return self

    def wait_for(self, text: str, after: int = 0, timeout_s: float = PATIENCE_S) -> int:
        """Wait for a line with a text; return the number of the line that follows it."""
        deadline = time.monotonic() + timeout_s
        with self._news:
            while True:
                for number, line in enumerate(self.lines[after:], after):
                    if text in line:
                        return number + 1
                left = deadline - time.monotonic()
                if left <= 0 or (self.process.poll() is not None and not self._reader.is_alive()):
                    raise AssertionError(f"no '{text}' after line {after} in {self.lines[-20:]}")
                self._news.wait(min(left, 0.2))

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._news:
                self.lines.append(line.rstrip())
                self._news.notify_all()
        with self._news:
            self._news.notify_all()
