"""Rotations, and processes by their names."""

from __future__ import annotations

from geometry_msgs.msg import Quaternion

from daidalos.common.pose3 import quaternion_from_rpy


def euler_to_quaternion(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """Return the rotation about x, then y, then z of the frame outside [rad]."""
    x, y, z, w = quaternion_from_rpy(roll, pitch, yaw)
    return Quaternion(x=x, y=y, z=z, w=w)


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
    """Kill a process; one that does not exist is not an error."""
    import contextlib

    import psutil

    with contextlib.suppress(psutil.NoSuchProcess):
        psutil.Process(pid).kill()


def kill_os_processes(name: str) -> None:
    """Kill all processes with a name in their command line."""
    for pid, _ in find_os_processes(name):
        kill_process(pid)
