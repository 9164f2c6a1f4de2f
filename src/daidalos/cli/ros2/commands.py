"""Built-in commands."""

from __future__ import annotations

from typing import Any

from ros2cli.extensions import Extensions, built_in

from daidalos.cli.ros2.extension import COMMAND_GROUP
from daidalos.common.extensions import Kind

BUILT_IN = {
    "action": "Various action related sub-commands",
    "bag": "Various rosbag related sub-commands",
    "component": "Various component related sub-commands",
    "control": "Various control related sub-commands",
    "daemon": "Various daemon related sub-commands",
    "doctor": "Check ROS setup and other potential issues",
    "extension_points": "List extension points",
    "extensions": "List extensions",
    "interface": "Show information about ROS interfaces",
    "launch": "Run a launch file",
    "lifecycle": "Various lifecycle related sub-commands",
    "multicast": "Various multicast related sub-commands",
    "node": "Various node related sub-commands",
    "param": "Various param related sub-commands",
    "pkg": "Various package related sub-commands",
    "run": "Run a package specific executable",
    "security": "Various security related sub-commands",
    "service": "Various service related sub-commands",
    "topic": "Various topic related sub-commands",
    "trace": "Trace ROS nodes to get information on their execution",
    "wtf": "Use `wtf` as alias to `doctor`",
}
"""Descriptions by name; each is the class ``<Name>Command`` in the module of its name beside this one."""


KIND: Kind[Any] = Kind(
    "ros2_command",
    COMMAND_GROUP,
    "ros2cli.subcommand:Subcommand",
    "a command of `ros2`",
    lambda: built_in(BUILT_IN, "daidalos.cli.ros2", "Command"),
)


def commands() -> Extensions:
    """Return the built-in commands and those of other packages."""
    return Extensions(KIND)
