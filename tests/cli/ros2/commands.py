"""Running `ros2` as a user does: in a process of its own."""

import os
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

import pytest

from daidalos.cli.ros2 import main

TIMEOUT_S = 40.0
ROS2 = [sys.executable, "-m", "daidalos.cli.ros2"]


@dataclass(frozen=True)
class Result:
    """What a command printed and its exit status; None where it was ended by Ctrl-C."""

    status: int | None
    out: str
    err: str


def ros2_here(*words: str, capsys: pytest.CaptureFixture[str]) -> Result:
    """Run a command that needs no graph, in this process."""
    try:
        status = main(list(words))
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 1
    return Result(status, *capsys.readouterr())


def environment(domain: int, **more: str) -> dict[str, str]:
    """Return an environment in which nobody else is in the domain."""
    kept = {name: value for name, value in os.environ.items() if name not in ("AMENT_PREFIX_PATH", "COLUMNS")}
    return {**kept, "ROS_DOMAIN_ID": str(domain), **more}


def ros2(
    *words: str, env: dict[str, str], cwd: Path | None = None, interrupt_after_lines: int | None = None, stdin: str = ""
) -> Result:
    """Run a command to its end, or press Ctrl-C once it has printed so many lines."""
    process = subprocess.Popen(
        [*ROS2, *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=env,
        cwd=cwd,
    )
    alarm = threading.Timer(TIMEOUT_S, process.kill)
    alarm.start()
    try:
        head, interrupted = "", False
        if interrupt_after_lines is not None:
            assert process.stdout is not None
            head = "".join(process.stdout.readline() for _ in range(interrupt_after_lines))
            interrupted = process.poll() is None
            if interrupted:
                process.send_signal(signal.SIGINT)
        out, err = process.communicate(stdin)
    finally:
        alarm.cancel()
    return Result(None if interrupted else process.returncode, head + out, err)
