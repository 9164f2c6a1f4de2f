"""Program that runs a command with a timeout, including its children: ``timed <seconds> <command>...``."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence

import psutil

TIMED_OUT = 124


def main(argv: Sequence[str]) -> int:
    """Return the exit status of the command, or `TIMED_OUT`."""
    process = subprocess.Popen(argv[1:])
    try:
        return process.wait(float(argv[0]))
    except subprocess.TimeoutExpired:
        _kill(process.pid)
        process.wait()
        return TIMED_OUT
    except KeyboardInterrupt:  # the command has got it too
        return process.wait()


def _kill(pid: int) -> None:
    parent = psutil.Process(pid)
    for process in [parent, *parent.children(recursive=True)]:
        try:
            process.kill()
        except psutil.NoSuchProcess:
            continue


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
