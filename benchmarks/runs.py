"""Runs in lock-step that are measured: each is a process, with its processor time and its memory."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ENVIRONMENT = {"RMW_IMPLEMENTATION": "rmw_daidalos_inprocess", "PYTHONHASHSEED": "0"}
LAUNCH = (sys.executable, "-m", "daidalos.cli.ros2", "launch", "--lockstep")


@dataclass(frozen=True)
class Cost:
    """Processor time [s] and greatest memory [MB] of a process that has ended, and what it printed."""

    seconds: float
    peak_mb: float
    output: str


def measure(command: Sequence[str], folder: Path, environment: Mapping[str, str] = ENVIRONMENT) -> Cost:
    """Run a command in a folder and return its cost.

    Raises
    ------
    RuntimeError
        When it fails, with its last lines.
    """
    path = folder / "output.txt"
    with path.open("w") as file:
        process = subprocess.Popen(
            command, cwd=folder, env=os.environ | dict(environment), stdout=file, stderr=subprocess.STDOUT
        )
        _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    output = path.read_text()
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}:\n{output[-2000:]}")
    return Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0, output)


def launch_until(folder: Path, seconds: float, *words: str) -> Cost:
    """Run a launch in lock-step until a simulated time [s] and return its cost."""
    return measure([*LAUNCH, "--until", f"{seconds:g}", *words], folder)
