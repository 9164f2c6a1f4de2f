"""The arguments of a launch description on the terminal."""

from __future__ import annotations

import sys

from launch import LaunchDescription


def print_arguments_of_launch_description(*, launch_description: LaunchDescription) -> None:
    """Print the arguments that a launch description declares, with what they are for and their defaults."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    arguments = launch_description.get_launch_arguments()
    for argument in arguments:
        lines += ["", f"    '{argument.name}':", f"        {argument.description}"]
        if argument.default_value is not None:
            default = " + ".join(part.describe() for part in argument.default_value)
            lines.append(f"        (default: {default})")
    if not arguments:
        lines += ["", "  No arguments."]
    sys.stdout.write("\n".join(lines) + "\n")
