"""Keys in a terminal, velocities on a topic."""

from __future__ import annotations

import pytest

from nodes.terminal import Terminal, until_shown

pytestmark = pytest.mark.slow

_RUN = ("run", "teleop_twist_keyboard", "teleop_twist_keyboard")


def test_keys_become_velocities(domain: int) -> None:
    with (
        Terminal("topic", "echo", "/cmd_vel", "geometry_msgs/msg/Twist", "--csv", domain=domain) as echo,
        Terminal(*_RUN, domain=domain) as teleop,
    ):
        teleop.wait_for("currently:\tspeed 0.5\tturn 1.0")
        until_shown("Subscription count: 1", "topic", "info", "/cmd_vel", domain=domain)  # the listener is known
        teleop.press("i")
        echo.wait_for("^0.5,0.0,0.0,0.0,0.0,0.0$")
        teleop.press("O")
        echo.wait_for("^0.5,-0.5,0.0,0.0,0.0,0.0$")
        teleop.press("b")
        echo.wait_for("^0.0,0.0,-0.5,0.0,0.0,0.0$")
        teleop.press(".")
        echo.wait_for("^-0.5,0.0,0.0,0.0,0.0,1.0$")
        teleop.press("e")
        teleop.wait_for("currently:\tspeed 0.5\tturn 1.1")
        teleop.press("j")
        echo.wait_for("^0.0,0.0,0.0,0.0,0.0,1.1")
        teleop.press("k")
        echo.wait_for("^0.0,0.0,0.0,0.0,0.0,0.0$")
        teleop.press("i")
        count = echo.lines.index(echo.wait_for("^0.5,", 2)[1])
        assert teleop.interrupt() == 0
        echo.wait_for("^0.0,0.0,0.0,0.0,0.0,0.0$", after=count)  # the robot stands still at the end
        echo.interrupt()


def test_stamped(domain: int) -> None:
    arguments = (
        "--ros-args",
        "-p",
        "stamped:=true",
        "-p",
        "frame_id:=base",
        "-p",
        "speed:=2.0",
        "-r",
        "cmd_vel:=drive",
    )
    with (
        Terminal("topic", "echo", "/drive", "geometry_msgs/msg/TwistStamped", domain=domain) as echo,
        Terminal(*_RUN, *arguments, domain=domain) as teleop,
    ):
        teleop.wait_for("currently:\tspeed 2.0\tturn 1.0")
        until_shown("Subscription count: 1", "topic", "info", "/drive", domain=domain)  # the listener is known
        teleop.press("i")
        echo.wait_for("frame_id: base")
        echo.wait_for("x: 2.0")
        assert teleop.terminate() == 0


def test_without_a_terminal_it_says_so(domain: int) -> None:
    import os
    import subprocess
    import sys

    done = subprocess.run(
        [sys.executable, "-m", "daidalos.cli.ros2", *_RUN],
        env=os.environ | {"ROS_DOMAIN_ID": str(domain)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2
    assert "standard input" in done.stderr
    assert "Traceback" not in done.stderr
