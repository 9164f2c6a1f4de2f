"""Turtlesim as a course uses it: programs in terminals, keys, commands."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from nodes.terminal import Terminal, until_shown

pytestmark = pytest.mark.slow

_UP = "\x1b[A"


def _ros2(domain: int, *words: str) -> str:
    with Terminal(*words, domain=domain) as command:
        assert command.wait(30) == 0, command.text
        return command.text


def _pose(domain: int, turtle: str = "turtle1", condition: str = "True") -> dict[str, float]:
    shown = _ros2(domain, "topic", "echo", "--once", "--filter", condition, f"/{turtle}/pose", "turtlesim/msg/Pose")
    return yaml.safe_load(shown.partition("---")[0])


@contextlib.contextmanager
def _turtlesim(domain: int, *words: str) -> Iterator[Terminal]:
    with Terminal("run", "turtlesim", "turtlesim_node", "--headless", *words, domain=domain) as simulator:
        until_shown("^/turtlesim$", "node", "list", domain=domain)
        yield simulator
        assert simulator.interrupt() == 0


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


def test_course_of_the_services(domain: int) -> None:
    with _turtlesim(domain) as simulator:
        spawn = ("service", "call", "/spawn", "turtlesim/srv/Spawn")
        assert "Spawn_Response(name='turtle2')" in _ros2(domain, *spawn, "{x: 2, y: 2, theta: 0.2, name: ''}")
        assert "Spawn_Response(name='bob')" in _ros2(domain, *spawn, "{x: 3, y: 3, theta: 0.2, name: bob}")
        assert "Spawn_Response(name='')" in _ros2(domain, *spawn, "{x: 3, y: 3, theta: 0.2, name: bob}")
        simulator.wait_for(
            r"\[turtlesim\]: Spawning turtle \[turtle2\] at x=\[2.000000\], y=\[2.000000\], theta=\[0.200000\]"
        )
        simulator.wait_for(r"\[turtlesim\]: A turtle named \[bob\] already exists")
        _ros2(domain, *spawn, "{name: not/so good}")
        simulator.wait_for(r"A turtle cannot be named \[not/so good\]: Invalid topic name")
        until_shown("^/bob/pose$", "topic", "list", domain=domain)

        _ros2(domain, "service", "call", "/kill", "turtlesim/srv/Kill", "{name: bob}")
        _ros2(domain, "service", "call", "/kill", "turtlesim/srv/Kill", "{name: bob}")
        simulator.wait_for(r"Tried to kill turtle \[bob\], which does not exist")
        assert "/bob/" not in _ros2(domain, "topic", "list") + _ros2(domain, "service", "list")

        teleport = ("service", "call", "/turtle1/teleport_absolute", "turtlesim/srv/TeleportAbsolute")
        _ros2(domain, *teleport, "{x: 3, y: 4, theta: 1.5}")
        teleported = {"x": 3.0, "y": 4.0, "theta": 1.5, "linear_velocity": 0.0, "angular_velocity": 0.0}
        assert _pose(domain) == teleported
        _ros2(domain, *teleport, "{x: .nan, y: 4, theta: 1.5}")
        simulator.wait_for(r"Turtle \[turtle1\] cannot obey \(nan, 4.0, 1.5\)")
        relative = ("service", "call", "/turtle1/teleport_relative", "turtlesim/srv/TeleportRelative")
        _ros2(domain, *relative, "{linear: 1, angular: -1.5}")
        assert _pose(domain)["x"] == pytest.approx(4.0)

        _ros2(domain, "service", "call", "/clear", "std_srvs/srv/Empty")
        simulator.wait_for(r"\[turtlesim\]: Clearing turtlesim.")
        _ros2(domain, "service", "call", "/reset", "std_srvs/srv/Empty")
        simulator.wait_for(r"\[turtlesim\]: Resetting turtlesim.")
        assert _pose(domain)["x"] == pytest.approx(5.544445, abs=1e-6)
        assert "turtle2" not in _ros2(domain, "topic", "list")


def test_colours_and_pens(domain: int, tmp_path: Path) -> None:
    parameters = tmp_path / "turtlesim.yaml"
    parameters.write_text("/turtlesim:\n  ros__parameters:\n    background_r: 10\n    background_g: 20\n")
    colour = ("topic", "echo", "--once", "/turtle1/color_sensor", "turtlesim/msg/Color")
    with _turtlesim(domain, "--ros-args", "--params-file", str(parameters)):
        assert _ros2(domain, *colour).split() == ["r:", "10", "g:", "20", "b:", "255", "---"]
        _ros2(domain, "param", "set", "/turtlesim", "background_b", "30")
        _ros2(domain, *colour[:3], "--filter", "m.b == 30", *colour[3:])
        with Terminal("param", "set", "/turtlesim", "background_b", "256", domain=domain) as command:
            command.wait_for("Setting parameter failed: ")
        _ros2(domain, "service", "call", "/turtle1/set_pen", "turtlesim/srv/SetPen", "{r: 1, g: 2, b: 3, width: 9}")
        teleport = ("service", "call", "/turtle1/teleport_relative", "turtlesim/srv/TeleportRelative")
        _ros2(domain, *teleport, "{linear: 1.0}")
        _ros2(domain, *colour[:3], "--filter", "(m.r, m.g, m.b) == (1, 2, 3)", *colour[3:])
        _ros2(domain, "service", "call", "/turtle1/set_pen", "turtlesim/srv/SetPen", "{'off': 1}")
        _ros2(domain, *teleport, "{linear: 1.0}")
        assert _ros2(domain, *colour).split() == ["r:", "10", "g:", "20", "b:", "30", "---"]


def test_walls(domain: int) -> None:
    with _turtlesim(domain) as simulator:
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 8.0}}")
        _ros2(domain, "topic", "pub", "--once", *words)
        simulator.wait_for(
            r"\[WARN\] \[.*\] \[turtlesim\]: Oh no! I hit the wall! \(Clamping from \[x=11.1\d+, y=5.544445\]\)"
        )
        assert _pose(domain, condition="m.linear_velocity == 0.0")["x"] == pytest.approx(11.088889, abs=1e-6)


def test_what_is_no_speed_moves_nobody(domain: int) -> None:
    with _turtlesim(domain) as simulator:
        for value in (".nan", ".inf", "1.0e300"):
            words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", f"{{linear: {{x: {value}}}}}")
            _ros2(domain, "topic", "pub", "--once", *words)
        simulator.wait_for(r"Turtle \[turtle1\] cannot obey \(", 3)
        assert _pose(domain)["x"] == pytest.approx(5.544445, abs=1e-6)


def test_robots_that_go_sideways(domain: int) -> None:
    with _turtlesim(domain, "--ros-args", "-p", "holonomic:=true"):
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {y: 1.0}}")
        _ros2(domain, "topic", "pub", "--once", *words)
        pose = _pose(domain, condition="m.y > 6.4 and m.linear_velocity == 0.0")
        assert pose["x"] == pytest.approx(5.544445, abs=1e-6)


def test_rotation_as_the_tutorial_shows_it(domain: int) -> None:
    goal = ("action", "send_goal", "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute", "{theta: 1.57}")
    with _turtlesim(domain):
        shown = _ros2(domain, *goal, "--feedback")
        assert "    remaining: 1.5700000524520874" in shown.splitlines()
        assert shown.splitlines()[-4:] == [
            "Result:",
            "    delta: -1.568000316619873",
            "",
            "Goal finished with status: SUCCEEDED",
        ]


def test_killed_while_it_turns(domain: int) -> None:
    goal = ("action", "send_goal", "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute", "{theta: 3.0}")
    with _turtlesim(domain), Terminal(*goal, domain=domain) as command:
        command.wait_for("Goal accepted")
        _ros2(domain, "service", "call", "/kill", "turtlesim/srv/Kill", "{name: turtle1}")
        command.wait_for("Goal finished with status: ABORTED")


def test_mimic(domain: int) -> None:
    remaps = ("-r", "input/pose:=turtle1/pose", "-r", "output/cmd_vel:=turtle2/cmd_vel")
    with (
        _turtlesim(domain),
        Terminal("run", "turtlesim", "mimic", "--ros-args", *remaps, domain=domain) as mimic,
    ):
        _ros2(domain, "service", "call", "/spawn", "turtlesim/srv/Spawn", "{x: 2, y: 2, theta: 0.0}")
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 1.0}, angular: {z: 1.0}}")
        _ros2(domain, "topic", "pub", "--once", *words)
        one = _pose(domain, condition="m.theta > 0.9 and m.linear_velocity == 0.0")
        other = _pose(domain, "turtle2", "m.theta > 0.9 and m.linear_velocity == 0.0")
        assert other["theta"] == pytest.approx(one["theta"], abs=0.2)
        assert mimic.interrupt() == 0


def test_draw_square(domain: int) -> None:
    with (
        _turtlesim(domain) as simulator,
        Terminal("run", "turtlesim", "draw_square", domain=domain) as square,
    ):
        simulator.wait_for("Resetting turtlesim.")
        goals = square.wait_for(r"\[draw_square\]: New goal \[", 3)
        square.wait_for(r"\[draw_square\]: Reached goal", 2)
        assert goals[0].endswith("New goal [7.544445 5.544445, 0.000000]")
        turned = float(goals[1].rstrip("]").split()[-1])
        assert turned == pytest.approx(math.pi / 2, abs=0.05)
        assert square.interrupt() == 0


@pytest.mark.parametrize("executable", ["turtlesim_node", "turtle_teleop_key", "mimic", "draw_square"])
def test_ends_quietly_however_it_is_ended(executable: str, domain: int) -> None:
    for end in (Terminal.interrupt, Terminal.terminate):
        with Terminal("run", "turtlesim", executable, domain=domain) as program:
            until_shown("^/", "node", "list", domain=domain)
            assert end(program) == 0


def test_wrong_arguments(domain: int) -> None:
    with Terminal("run", "turtlesim", "turtlesim_node", "--headles", domain=domain) as program:
        assert program.wait(30) == 2
        assert "unrecognized arguments: --headles" in program.text
    words = ("--headless", "--ros-args", "-p", "background_r:=300")
    with Terminal("run", "turtlesim", "turtlesim_node", *words, domain=domain) as program:
        assert program.wait(30) != 0
        assert "background_r:=300: parameter 'background_r' of /turtlesim must be at most 255, got 300" in program.text
