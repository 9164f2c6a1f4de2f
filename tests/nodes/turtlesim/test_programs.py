"""Turtlesim as a course uses it: programs in terminals, keys, commands."""

from __future__ import annotations

import subprocess
import sys

import pytest

from nodes.terminal import Terminal

pytestmark = pytest.mark.slow

_UP = "\x1b[A"


def _ros2(domain: int, *words: str) -> str:
    import os

    done = subprocess.run(
        [sys.executable, "-m", "daidalos.cli.ros2", *words],
        env=os.environ | {"ROS_DOMAIN_ID": str(domain)},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_keys_move_turn_and_cancel(domain: int) -> None:
    with (
        Terminal("run", "turtlesim", "turtlesim_node", "--headless", domain=domain) as simulator,
        Terminal("run", "turtlesim", "turtle_teleop_key", domain=domain) as teleop,
    ):
        simulator.wait_for(r"Spawning turtle \[turtle1\] at x=\[5.544445\], y=\[5.544445\], theta=\[0.000000\]")
        teleop.wait_for("'Q' to quit.")
        _ros2(domain, "topic", "echo", "--once", "/turtle1/pose")
        teleop.press("t")
        simulator.wait_for(r"\[turtlesim\]: Rotation goal completed successfully")
        teleop.press("d")
        teleop.press("f")
        simulator.wait_for(r"\[turtlesim\]: Rotation goal canceled")
        teleop.press("d")
        teleop.press("g")
        simulator.wait_for("Rotation goal received before a previous goal finished. Aborting previous goal")
        simulator.wait_for("Rotation goal completed successfully", 2)
        teleop.press(_UP)
        _ros2(domain, "topic", "echo", "--once", "--filter", "m.x > 7", "/turtle1/pose")
        teleop.press("q")
        assert teleop.wait() == 0
        assert simulator.interrupt() == 0
