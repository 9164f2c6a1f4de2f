"""The way from a launch file in markup to its launch description."""

from __future__ import annotations

from ..frontend.parser import Parser
from ..launch_description import LaunchDescription


def get_launch_description_from_frontend_launch_file(
    frontend_launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """Read a launch file in markup.

    Parameters
    ----------
    frontend_launch_file_path
        The file.
    parser
        The parser; the base class stands for the one that the file's extension names.
    """
    root, file_parser = parser.load(frontend_launch_file_path)
    return file_parser.parse_description(root)
