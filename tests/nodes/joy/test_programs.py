"""The programs that drive with game pads start, are in the graph, and end at Ctrl-C."""

from __future__ import annotations

import pytest

from nodes.terminal import Terminal, until_node

pytestmark = pytest.mark.slow


def test_a_game_pad_drives_through_the_multiplexer(domain: int) -> None:
    pad = ("launch", "teleop_twist_joy", "teleop-launch.py", "joy_vel:=joy_vel", "joy_config:=xbox")
    mux = ("launch", "twist_mux", "twist_mux_launch.py", "cmd_vel_out:=cmd_vel")
    joy = "{axes: [0.0, 1.0], buttons: [0, 0, 0, 0, 1, 0]}"
    with Terminal(*pad, domain=domain) as pads, Terminal(*mux, domain=domain) as multiplexer:
        until_node("^/twist_mux$", domain=domain)
        until_node("^/teleop_twist_joy_node$", domain=domain)
        until_node("^/joy_node$", domain=domain)
        with Terminal("topic", "pub", "-r", "10", "/joy", "sensor_msgs/msg/Joy", joy, domain=domain) as player:
            with Terminal("topic", "echo", "--once", "/cmd_vel", "--field", "linear.x", domain=domain) as echo:
                assert echo.wait(30) == 0
                assert "0.7" in echo.lines
            player.interrupt()
        for program in (pads, multiplexer):
            program.interrupt()
            assert "rror" not in program.text
            assert "Traceback" not in program.text


@pytest.mark.parametrize("executable", [("joy", "joy_node"), ("joy_linux", "joy_linux_node")])
def test_waiting_for_a_game_pad_ends_at_once(executable: tuple[str, str], domain: int) -> None:
    with Terminal("run", *executable, domain=domain) as program:
        until_node("^/joy_node$", domain=domain)
        assert program.interrupt() == 0
        assert "rror" not in program.text
