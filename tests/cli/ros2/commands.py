"""Running `ros2` as a user does: in a process of its own."""

import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROS2 = [sys.executable, "-m", "daidalos.cli.ros2"]


@dataclass(frozen=True)
class Result:
    """What a command printed and its exit status; None where it was ended by Ctrl-C."""

    status: int | None
    out: str
    err: str


def environment(domain: int, **more: str) -> dict[str, str]:
    """Return an environment in which nobody else is in the domain."""
    kept = {name: value for name, value in os.environ.items() if name not in ("AMENT_PREFIX_PATH", "COLUMNS")}
    return {**kept, "ROS_DOMAIN_ID": str(domain), **more}


def ros2(
    *words: str, env: dict[str, str], cwd: Path | None = None, interrupt_after_s: float | None = None, stdin: str = ""
) -> Result:
    """Run a command to its end, or have it interrupted."""
    process = subprocess.Popen(
        [*ROS2, *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=env,
        cwd=cwd,
    )
    try:
        out, err = process.communicate(stdin, timeout=interrupt_after_s or 60)
        status: int | None = process.returncode
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=5)
        status = None if interrupt_after_s else process.returncode
    return Result(status, out, err)
