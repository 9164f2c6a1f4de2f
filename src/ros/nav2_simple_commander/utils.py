"""Rotations, and processes by their names."""

from __future__ import annotations

import math

from geometry_msgs.msg import Quaternion


def euler_to_quaternion(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """Return the rotation about x, then y, then z of the frame outside [rad]."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle / 2), math.sin(angle / 2)) for angle in (roll, pitch, yaw))
    return Quaternion(
        x=sr * cp * cy - cr * sp * sy,
        y=cr * sp * cy + sr * cp * sy,
        z=cr * cp * sy - sr * sp * cy,
        w=cr * cp * cy + sr * sp * sy,
    )


def find_os_processes(name: str) -> list[tuple[int, str]]:
    """Return the numbers and command lines of the processes in whose command line a name is."""
    import psutil

    found = []
    for process in psutil.process_iter(["pid", "cmdline"]):
        words = " ".join(process.info["cmdline"] or ())
        if name in words:
            found.append((process.info["pid"], words))
    return found


def kill_process(pid: int) -> None:
    """End a process at once; one that is not there is no mistake."""
    import contextlib

    import psutil

    with contextlib.suppress(psutil.NoSuchProcess):
        psutil.Process(pid).kill()


def kill_os_processes(name: str) -> None:
    """End at once all processes in whose command line a name is."""
    for pid, _ in find_os_processes(name):
        kill_process(pid)
