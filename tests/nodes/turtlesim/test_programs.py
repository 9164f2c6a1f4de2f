"""Turtlesim as a course uses it: programs in terminals, keys, commands."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from nodes.stepped_terminal import Terminal as SteppedTerminal
from nodes.stepped_terminal import Terminals
from nodes.terminal import Terminal, until_node

pytestmark = pytest.mark.slow
stepped = pytest.mark.scenario(timeout=300, record=False)

_UP = "\x1b[A"


def _pose(terminal: Terminals, turtle: str = "turtle1", condition: str = "True") -> dict[str, float]:
    words = ("topic", "echo", "--once", "--filter", condition, f"/{turtle}/pose", "turtlesim/msg/Pose")
    return yaml.safe_load(terminal.ros2(*words).partition("---")[0])


@contextlib.contextmanager
def _turtlesim(terminal: Terminals, *words: str) -> Iterator[SteppedTerminal]:
    with terminal("run", "turtlesim", "turtlesim_node", "--headless", *words) as simulator:
        terminal.until_shown("^/turtlesim$", "node", "list")
        yield simulator
        assert simulator.interrupt() == 0


def _echo_once(domain: int, *words: str) -> None:
    with Terminal("topic", "echo", "--once", *words, domain=domain) as command:
        assert command.wait(30) == 0, command.text


def test_keys_move_turn_and_cancel(domain: int) -> None:
    with (
        Terminal("run", "turtlesim", "turtlesim_node", "--headless", domain=domain) as simulator,
        Terminal("run", "turtlesim", "turtle_teleop_key", domain=domain) as teleop,
    ):
        simulator.wait_for(r"Spawning turtle \[turtle1\] at x=\[5.544445\], y=\[5.544445\], theta=\[0.000000\]")
        teleop.wait_for("'Q' to quit.")
        _echo_once(domain, "/turtle1/pose")
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
        _echo_once(domain, "--filter", "m.x > 7", "/turtle1/pose")
        teleop.press("q")
        assert teleop.wait() == 0
        assert simulator.interrupt() == 0


@stepped
def test_course_of_the_services(terminal: Terminals) -> None:
    with _turtlesim(terminal) as simulator:
        spawn = ("service", "call", "/spawn", "turtlesim/srv/Spawn")
        assert "Spawn_Response(name='turtle2')" in terminal.ros2(*spawn, "{x: 2, y: 2, theta: 0.2, name: ''}")
        assert "Spawn_Response(name='bob')" in terminal.ros2(*spawn, "{x: 3, y: 3, theta: 0.2, name: bob}")
        assert "Spawn_Response(name='')" in terminal.ros2(*spawn, "{x: 3, y: 3, theta: 0.2, name: bob}")
        simulator.wait_for(
            r"\[turtlesim\]: Spawning turtle \[turtle2\] at x=\[2.000000\], y=\[2.000000\], theta=\[0.200000\]"
        )
        simulator.wait_for(r"\[turtlesim\]: A turtle named \[bob\] already exists")
        terminal.ros2(*spawn, "{name: not/so good}")
        simulator.wait_for(r"A turtle cannot be named \[not/so good\]: Invalid topic name")
        terminal.until_shown("^/bob/pose$", "topic", "list")

        terminal.ros2("service", "call", "/kill", "turtlesim/srv/Kill", "{name: bob}")
        terminal.ros2("service", "call", "/kill", "turtlesim/srv/Kill", "{name: bob}")
        simulator.wait_for(r"Tried to kill turtle \[bob\], which does not exist")
        assert "/bob/" not in terminal.ros2("topic", "list") + terminal.ros2("service", "list")

        teleport = ("service", "call", "/turtle1/teleport_absolute", "turtlesim/srv/TeleportAbsolute")
        terminal.ros2(*teleport, "{x: 3, y: 4, theta: 1.5}")
        teleported = {"x": 3.0, "y": 4.0, "theta": 1.5, "linear_velocity": 0.0, "angular_velocity": 0.0}
        assert _pose(terminal) == teleported
        terminal.ros2(*teleport, "{x: .nan, y: 4, theta: 1.5}")
        simulator.wait_for(r"Turtle \[turtle1\] cannot obey \(nan, 4.0, 1.5\)")
        relative = ("service", "call", "/turtle1/teleport_relative", "turtlesim/srv/TeleportRelative")
        terminal.ros2(*relative, "{linear: 1, angular: -1.5}")
        assert _pose(terminal)["x"] == pytest.approx(4.0)

        terminal.ros2("service", "call", "/clear", "std_srvs/srv/Empty")
        simulator.wait_for(r"\[turtlesim\]: Clearing turtlesim.")
        terminal.ros2("service", "call", "/reset", "std_srvs/srv/Empty")
        simulator.wait_for(r"\[turtlesim\]: Resetting turtlesim.")
        assert _pose(terminal)["x"] == pytest.approx(5.544445, abs=1e-6)
        assert "turtle2" not in terminal.ros2("topic", "list")


@stepped
def test_colours_and_pens(terminal: Terminals, tmp_path: Path) -> None:
    parameters = tmp_path / "turtlesim.yaml"
    parameters.write_text("/turtlesim:\n  ros__parameters:\n    background_r: 10\n    background_g: 20\n")
    colour = ("topic", "echo", "--once", "/turtle1/color_sensor", "turtlesim/msg/Color")
    with _turtlesim(terminal, "--ros-args", "--params-file", str(parameters)):
        assert terminal.ros2(*colour).split() == ["r:", "10", "g:", "20", "b:", "255", "---"]
        terminal.ros2("param", "set", "/turtlesim", "background_b", "30")
        terminal.ros2(*colour[:3], "--filter", "m.b == 30", *colour[3:])
        with terminal("param", "set", "/turtlesim", "background_b", "256") as command:
            command.wait_for("Setting parameter failed: ")
        terminal.ros2("service", "call", "/turtle1/set_pen", "turtlesim/srv/SetPen", "{r: 1, g: 2, b: 3, width: 9}")
        teleport = ("service", "call", "/turtle1/teleport_relative", "turtlesim/srv/TeleportRelative")
        terminal.ros2(*teleport, "{linear: 1.0}")
        terminal.ros2(*colour[:3], "--filter", "(m.r, m.g, m.b) == (1, 2, 3)", *colour[3:])
        terminal.ros2("service", "call", "/turtle1/set_pen", "turtlesim/srv/SetPen", "{'off': 1}")
        terminal.ros2(*teleport, "{linear: 1.0}")
        assert terminal.ros2(*colour).split() == ["r:", "10", "g:", "20", "b:", "30", "---"]


@stepped
def test_walls(terminal: Terminals) -> None:
    with _turtlesim(terminal) as simulator:
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 8.0}}")
        terminal.ros2("topic", "pub", "--once", *words)
        simulator.wait_for(
            r"\[WARN\] \[.*\] \[turtlesim\]: Oh no! I hit the wall! \(Clamping from \[x=11.1\d+, y=5.544445\]\)"
        )
        assert _pose(terminal, condition="m.linear_velocity == 0.0")["x"] == pytest.approx(11.088889, abs=1e-6)


@stepped
def test_what_is_no_speed_moves_nobody(terminal: Terminals) -> None:
    with _turtlesim(terminal) as simulator:
        for value in (".nan", ".inf", "1.0e300"):
            words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", f"{{linear: {{x: {value}}}}}")
            terminal.ros2("topic", "pub", "--once", *words)
        simulator.wait_for(r"Turtle \[turtle1\] cannot obey \(", 3)
        assert _pose(terminal)["x"] == pytest.approx(5.544445, abs=1e-6)


@stepped
def test_robots_that_go_sideways(terminal: Terminals) -> None:
    with _turtlesim(terminal, "--ros-args", "-p", "holonomic:=true"):
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {y: 1.0}}")
        terminal.ros2("topic", "pub", "--once", *words)
        pose = _pose(terminal, condition="m.y > 6.4 and m.linear_velocity == 0.0")
        assert pose["x"] == pytest.approx(5.544445, abs=1e-6)


@stepped
def test_rotation_as_the_tutorial_shows_it(terminal: Terminals) -> None:
    goal = ("action", "send_goal", "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute", "{theta: 1.57}")
    with _turtlesim(terminal):
        shown = terminal.ros2(*goal, "--feedback")
        assert "    remaining: 1.5700000524520874" in shown.splitlines()
        assert shown.splitlines()[-4:] == [
            "Result:",
            "    delta: -1.568000316619873",
            "",
            "Goal finished with status: SUCCEEDED",
        ]


@stepped
def test_killed_while_it_turns(terminal: Terminals) -> None:
    goal = ("action", "send_goal", "/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute", "{theta: 3.0}")
    with _turtlesim(terminal), terminal(*goal) as command:
        command.wait_for("Goal accepted")
        terminal.ros2("service", "call", "/kill", "turtlesim/srv/Kill", "{name: turtle1}")
        command.wait_for("Goal finished with status: ABORTED")


@stepped
def test_mimic(terminal: Terminals) -> None:
    remaps = ("-r", "input/pose:=turtle1/pose", "-r", "output/cmd_vel:=turtle2/cmd_vel")
    with (
        _turtlesim(terminal),
        terminal("run", "turtlesim", "mimic", "--ros-args", *remaps) as mimic,
    ):
        terminal.ros2("service", "call", "/spawn", "turtlesim/srv/Spawn", "{x: 2, y: 2, theta: 0.0}")
        words = ("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 1.0}, angular: {z: 1.0}}")
        terminal.ros2("topic", "pub", "--once", *words)
        one = _pose(terminal, condition="m.theta > 0.9 and m.linear_velocity == 0.0")
        other = _pose(terminal, "turtle2", "m.theta > 0.9 and m.linear_velocity == 0.0")
        assert other["theta"] == pytest.approx(one["theta"], abs=0.2)
        assert mimic.interrupt() == 0


@stepped
def test_draw_square(terminal: Terminals) -> None:
    with (
        _turtlesim(terminal) as simulator,
        terminal("run", "turtlesim", "draw_square") as square,
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
            until_node("^/", domain=domain)
            assert end(program) == 0


def test_wrong_arguments(domain: int) -> None:
    with Terminal("run", "turtlesim", "turtlesim_node", "--headles", domain=domain) as program:
        assert program.wait(30) == 2
        assert "unrecognized arguments: --headles" in program.text
    words = ("--headless", "--ros-args", "-p", "background_r:=300")
    with Terminal("run", "turtlesim", "turtlesim_node", *words, domain=domain) as program:
        assert program.wait(30) != 0
        assert "background_r:=300: parameter 'background_r' of /turtlesim must be at most 255, got 300" in program.text
