"""The commands that are built in."""

from __future__ import annotations

from importlib import import_module

from ros2cli.extensions import Extensions

from daidalos.cli.ros2.extension import COMMAND_GROUP, Command
from daidalos.cli.ros2.verbs import class_name

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


def commands() -> Extensions:
    """Return the commands, built-in and added."""
    return Extensions(COMMAND_GROUP, BUILT_IN, _load)


def _load(name: str) -> Command:
    module = import_module(f"daidalos.cli.ros2.{name}")
    command: Command = getattr(module, class_name(name, "Command"))()
    return command
