"""Processes that take part in a benchmark: each runs one role of a module and tells by its output."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

READY = "ready"


def start(module: str, role: str, *arguments: str) -> subprocess.Popen[str]:
    """Start a role, a function that ``python -m benchmarks.<module>`` calls with arguments."""
    command = [sys.executable, "-m", f"benchmarks.{module}", role, *arguments]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@contextmanager
def running(module: str, role: str, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Run a role that has reported that it is ready; it ends when its input does."""
    process = start(module, role, *arguments)
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == f"{READY}\n"
        yield process
    finally:
        with suppress(BrokenPipeError, subprocess.TimeoutExpired):
            process.communicate(timeout=20)
        process.kill()


def result(process: subprocess.Popen[str]) -> dict[str, Any]:
    """Return what a role reported, once it has ended."""
    output, _ = process.communicate(timeout=180)
    return dict(json.loads(output.splitlines()[-1]))


def report(**values: Any) -> None:
    """Print what a role measured."""
    print(json.dumps(values), flush=True)


def say_ready() -> None:
    """Report that a role is ready."""
    print(READY, flush=True)


def middle_and_tail_us(times: list[float]) -> tuple[float, float]:
    """Return the 50th and the 99th percentile of seconds, in microseconds."""
    times = sorted(times)
    return times[len(times) // 2] * 1e6, times[len(times) * 99 // 100] * 1e6
