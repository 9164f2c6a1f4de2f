"""Splitting of meshes in processes of their own, since threads of one process share Python's lock."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion.convex import split_pieces
from daidalos.simulation.conversion.decomposition import Cancelled


class SplittingProcess:
    """Process that splits meshes, started with the first; it ends with this process, in whatever way that ends."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False
        self._lock = threading.Lock()

    def split(
        self, pieces: list[TriangleMesh], is_cancelled: Callable[[], bool] = lambda: False
    ) -> list[list[TriangleMesh]]:
        """Return the convex parts of pieces as `split_pieces` does; in this process where another one fails.

        Raises
        ------
        Cancelled
            After `close`, in another thread.
        """
        try:
            return self._ask(pieces)
        except (OSError, EOFError, pickle.UnpicklingError):  # it could not start, or was ended
            if self._closed:
                raise Cancelled from None
            return split_pieces(pieces, is_cancelled)

    def close(self) -> None:
        """End the process."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
                self._process.wait()

    def _ask(self, pieces: list[TriangleMesh]) -> list[list[TriangleMesh]]:
        with self._lock:
            if self._closed:
                raise EOFError
            if self._process is None:
                self._process = subprocess.Popen(
                    [sys.executable, "-P", "-m", __name__],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,  # a failure is seen when the work is done again in this process
                )
            process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        pickle.dump(pieces, process.stdin)
        process.stdin.flush()
        parts: list[list[TriangleMesh]] = pickle.load(process.stdout)
        return parts


def main() -> None:
    """Split what comes from the standard input until it ends or the parent does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the parent decides
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # nothing that is printed may come between the answers
    parent = os.getppid()
    requests: Any = sys.stdin.buffer
    while True:
        try:
            pieces = pickle.load(requests)
        except EOFError:
            return
        pickle.dump(split_pieces(pieces, lambda: os.getppid() != parent), answers)
        answers.flush()


if __name__ == "__main__":
    main()
