"""Common parts of launch files."""

from __future__ import annotations

from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


class DeclareBooleanLaunchArg(DeclareLaunchArgument):
    """Launch argument that is true or false.

    Parameters
    ----------
    name
        Name of the argument.
    default_value
        Its value where none is given.
    description
        What it is for.
    keywords
        For `DeclareLaunchArgument`.
    """

    def __init__(
        self, name: str, *, default_value: bool = False, description: str | None = None, **keywords: Any
    ) -> None:
        choices = ["true", "false", "True", "False"]
        super().__init__(name, default_value=str(default_value), description=description, choices=choices, **keywords)


def add_debuggable_node(
    ld: LaunchDescription,
    package: str,
    executable: str,
    condition_name: str = "debug",
    commands_file: str | None = None,
    extra_debug_args: list[str] | None = None,
    **keywords: Any,
) -> None:
    """Add a node to a launch description, which runs in gdb if a launch argument is true.

    Parameters
    ----------
    ld
        The launch description.
    package, executable, keywords
        For `launch_ros.actions.Node`.
    condition_name
        The launch argument.
    commands_file
        File with commands of gdb.
    extra_debug_args
        Further arguments of the node in gdb.
    """
    debug = LaunchConfiguration(condition_name)
    ld.add_action(Node(package=package, executable=executable, condition=UnlessCondition(debug), **keywords))
    arguments = [*keywords.pop("arguments", []), *(extra_debug_args or [])]
    commands = f"-x {commands_file} " if commands_file else ""
    ld.add_action(
        Node(
            package=package,
            executable=executable,
            condition=IfCondition(debug),
            prefix=[f"gdb {commands}--ex run --args"],
            arguments=arguments,
            **keywords,
        )
    )
