"""Starting other processes for a test and listening to what they say."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Self

from printed import Printed

TIMEOUT_S = 30.0
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
        self.process = subprocess.Popen(
            [*prefix, sys.executable, "-P", str(script), role],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=os.environ | environment | {"PYTHONPATH": os.pathsep.join(sys.path)},
        )
        assert self.process.stdout is not None
        self._printed = Printed(self.process.stdout)
        self.lines = self._printed.lines

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
        self._printed.join()

    def ready(self, timeout_s: float = TIMEOUT_S) -> Self:
        """Wait until it is ready; a process that does not get so far is killed."""
        try:
            self.wait_for("ready", timeout_s=timeout_s)
        except BaseException:
            self.kill()
            raise
        return self

    def wait_for(self, text: str, after: int = 0, timeout_s: float = TIMEOUT_S) -> int:
        """Wait for a line with a text; return the number of the line that follows it."""
        found = self._printed.wait(
            lambda: next((n + 1 for n, line in enumerate(self.lines[after:], after) if text in line), None), timeout_s
        )
        assert found is not None, f"no '{text}' after line {after} in {self.lines[-20:]}"
        return found
