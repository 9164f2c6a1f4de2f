"""Held keys in a terminal, velocities on a topic."""

from __future__ import annotations

import pytest

from nodes.terminal import Terminal

pytestmark = pytest.mark.slow

_UP, _LEFT = "\x1b[A", "\x1b[D"


def test_held_keys_become_velocities(domain: int) -> None:
    with (
        Terminal("run", "key_teleop", "key_teleop", domain=domain) as teleop,
        Terminal("topic", "echo", "/key_vel", "geometry_msgs/msg/Twist", "--csv", domain=domain) as echo,
    ):
        teleop.wait_for("Use arrow keys to move, q to exit.")
        echo.wait_for("^0.0,0.0,0.0,0.0,0.0,0.0$")
        teleop.press(_UP + _LEFT)
        echo.wait_for("^0.8,0.0,0.0,0.0,0.0,1.0$")
        count = echo.lines.index(echo.wait_for("^0.8,0.0,0.0,0.0,0.0,1.0$")[0])
        echo.wait_for("^0.0,0.0,0.0,0.0,0.0,0.0$", after=count)  # nothing is held any more
        teleop.press("q")
        assert teleop.wait() == 0
        echo.interrupt()
