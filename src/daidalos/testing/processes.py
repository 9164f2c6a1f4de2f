"""Client of the processes in which scenarios run."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from types import TracebackType

from daidalos.lockstep.start import ENVIRONMENT
from daidalos.testing.server import LENGTH, Request
from daidalos.workspaces.orphans import guard


class ScenarioProcess:
    """Process that carries out scenarios one after the other; it starts with the first one.

    Parameters
    ----------
    *preloaded : str
        ``pytest`` where the scenarios are tests of pytest.
    """

    def __init__(self, *preloaded: str) -> None:
        self._preloaded = preloaded
        self._process: subprocess.Popen[bytes] | None = None

    def run(self, request: Request) -> int:
        """Carry out a scenario; return its exit status, negative when a signal has ended it."""
        process = self._running()
        data = pickle.dumps(request)
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(LENGTH.pack(len(data)) + data)
            process.stdin.flush()
            answer = process.stdout.read(LENGTH.size)
        except (BrokenPipeError, BaseException) as error:
            self.close()
            if isinstance(error, BrokenPipeError):
                return 1
            raise
        if len(answer) < LENGTH.size:
            status = process.wait()
            self.close()
            return status or 1
        return int(LENGTH.unpack(answer)[0])

    def close(self) -> None:
        """End the process, and the scenario that it runs."""
        process, self._process = self._process, None
        if process is None:
            return
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.close()
        process.wait()
        process.stdout.close()
        guard.release(process.pid)

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self.close()
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "daidalos.testing.server", *self._preloaded],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env=os.environ | ENVIRONMENT,
                start_new_session=True,  # Ctrl-C reaches whoever asked, who ends it
            )
            guard.watch(self._process.pid)
        return self._process

    def __enter__(self) -> ScenarioProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def scenario_environment() -> dict[str, str]:
    """Return the environment of a scenario that is started from this process."""
    return dict(os.environ) | ENVIRONMENT
