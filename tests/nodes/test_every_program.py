"""Every program of the course's packages starts, is in the graph, and ends at Ctrl-C without a word too many."""

from __future__ import annotations

import pytest

from daidalos.workspaces.executables import executables
from nodes.terminal import Terminal, until_node

pytestmark = pytest.mark.slow

# Those that open the studio: test_studio_commands.py; turtlesim's: turtlesim/test_programs.py.
_PACKAGES = (
    "action_tutorials_py",
    "composition",
    "demo_nodes_cpp",
    "demo_nodes_py",
    "examples_rclpy_minimal_action_client",
    "examples_rclpy_minimal_action_server",
    "examples_rclpy_minimal_client",
    "examples_rclpy_minimal_publisher",
    "examples_rclpy_minimal_service",
    "examples_rclpy_minimal_subscriber",
    "key_teleop",
    "teleop_twist_keyboard",
    "tf2_ros",
    "tf2_tools",
    "topic_tools",
    "turtle_tf2_py",
)
_EXPRESSION = ("/nobody", "/out", "std_msgs/Header", "{frame_id: m.data}", "-w")
_ARGUMENTS = {
    ("composition", "dlopen_composition"): ("lib/libtalker_component.so",),
    ("tf2_ros", "static_transform_publisher"): ("--frame-id", "a", "--child-frame-id", "b"),
    ("tf2_ros", "tf2_echo"): ("a", "b"),
    ("tf2_tools", "view_frames"): ("-t", "60"),
    ("topic_tools", "delay"): ("/chatter", "1.0"),
    ("topic_tools", "demux"): ("/chatter", "/a"),
    ("topic_tools", "drop"): ("/chatter", "1", "2"),
    ("topic_tools", "mux"): ("/out", "/chatter"),
    ("topic_tools", "relay"): ("/chatter",),
    ("topic_tools", "relay_field"): _EXPRESSION,
    ("topic_tools", "throttle"): ("messages", "/chatter", "1"),
    ("topic_tools", "transform"): _EXPRESSION[:3] + _EXPRESSION[4:],
    ("turtle_tf2_py", "static_turtle_tf2_broadcaster"): ("turtle", "0", "0", "0", "0", "0", "0"),
}


@pytest.mark.parametrize(("package", "executable"), [(name, each) for name in _PACKAGES for each in executables(name)])
def test_program(package: str, executable: str, domain: int) -> None:
    words = _ARGUMENTS.get((package, executable), ())
    with Terminal("run", package, executable, *words, domain=domain) as program:
        until_node("^/", domain=domain)
        assert program.interrupt() == 0
        assert "rror" not in program.text


def test_packages_are_listed(domain: int) -> None:
    with Terminal("pkg", "list", domain=domain) as command:
        assert command.wait(30) == 0
        assert set(_PACKAGES) <= set(command.lines)
