"""Ctrl-C at any moment: no traceback, and nothing is left behind."""

import contextlib
import os
import signal
import subprocess
import time

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
# Before that the interpreter itself begins, and nobody can tell it what to do.
MOMENTS_S = (0.06, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0)


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
    """Wait until the command handles the signal or, on a busy machine, a moment that is counted in its own time."""
    observed = psutil.Process(process.pid)
    with contextlib.suppress(psutil.NoSuchProcess):
        while process.poll() is None and (times := observed.cpu_times()).user + times.system < MOMENTS_S[0]:
            time.sleep(0.005)
    time.sleep(moment_s - MOMENTS_S[0])


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
