"""Ctrl-C at any moment: no traceback, and nothing is left behind."""

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path

import psutil
import pytest

from .commands import ROS2

LAUNCH = """<launch>
  <node pkg="demo_nodes_py" exec="talker" respawn="true"/>
  <node pkg="demo_nodes_py" exec="listener"/>
</launch>
"""
COMMANDS = {
    "list": ["topic", "list", "--no-daemon"],
    "echo": ["topic", "echo", "/nothing", "std_msgs/msg/String"],
    "hz": ["topic", "hz", "/nothing"],
    "pub": ["topic", "pub", "/x", "std_msgs/msg/String", "data: x"],
    "call": ["service", "call", "/nothing", "std_srvs/srv/Trigger"],
    "run": ["run", "demo_nodes_py", "talker"],
    "launch": ["launch", "two.launch.xml"],
}
# After the command has taken over the signal; until then the interpreter starts, which no program can influence.
MOMENTS_S = (0.0, 0.04, 0.1, 0.15, 0.25, 0.45, 0.95)


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_at_any_moment(env, tmp_path, name):
    (tmp_path / "two.launch.xml").write_text(LAUNCH)
    for moment in MOMENTS_S:
        process = subprocess.Popen(
            [*ROS2, *COMMANDS[name]],
            env={**env, "ROS_LOG_DIR": str(tmp_path)},
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        _wait_until_ours(process, moment)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT)
        told = process.communicate(timeout=30)[0]
        left = _left_of(process.pid)
        assert not left, f"{left} was left at {moment} s"
        assert "Traceback" not in told, f"at {moment} s"
        assert process.returncode in (0, 2, -signal.SIGINT), f"at {moment} s"


@pytest.mark.parametrize("inherited", [signal.SIG_DFL, signal.SIG_IGN], ids=["terminal", "background of a script"])
def test_the_status_is_that_of_ros2(env, inherited):
    process = subprocess.Popen(
        [*ROS2, "topic", "hz", "/nothing"],
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, inherited),
    )
    assert process.stdout.readline().startswith("WARNING")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err) == (2, "", "")


def _wait_until_ours(process: subprocess.Popen[str], moment_s: float) -> None:
    """Wait until the command has replaced the interpreter's handler of the signal, and for a moment after that."""
    observed = psutil.Process(process.pid)
    has_python_started = False
    with contextlib.suppress(psutil.NoSuchProcess):
        while process.poll() is None and observed.num_threads() == 1:  # those of the graph come after that
            is_caught = _is_caught(process.pid, signal.SIGINT)
            if has_python_started and not is_caught:
                break
            has_python_started |= is_caught
            time.sleep(0.002)
    time.sleep(moment_s)


def _is_caught(pid: int, number: int) -> bool:
    """Return whether a process of Linux has a handler for a signal, False once it has ended."""
    with contextlib.suppress(FileNotFoundError, ProcessLookupError):
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("SigCgt:"):
                return bool(int(line.split()[1], 16) >> (number - 1) & 1)
    return False


def _left_of(group: int, timeout_s: float = 10.0) -> list[str]:
    """Return what does not leave a process group; it is killed."""
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return []
        time.sleep(0.02)
    left = [" ".join(one.cmdline()) for one in psutil.process_iter() if os.getpgid(one.pid) == group]
    os.killpg(group, signal.SIGKILL)
    return left
