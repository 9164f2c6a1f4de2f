"""The way from a launch file of any kind to its launch description."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from ..launch_file_error import add_location
from .python_launch_file_utilities import get_launch_description_from_python_launch_file

if TYPE_CHECKING:
    from ..frontend.parser import Parser

_MARKUP = {"xml", "yaml", "yml", "launch"}


def get_launch_description_from_any_launch_file(
    launch_file_path: str, *, parser: type[Parser] | None = None
) -> LaunchDescription:
    """Read a launch file by the rules of what it is written in, which its extension says.

    A file with an extension that says nothing is tried as every kind.

    Parameters
    ----------
    launch_file_path
        The file.
    parser
        The parser for files in markup; not given, the one that the file's extension names.

    Raises
    ------
    InvalidLaunchFileError
        If no kind fits.
    OSError
        If the file cannot be read.
    """
    if not os.path.isfile(launch_file_path):
        raise FileNotFoundError(f"the launch file '{launch_file_path}' does not exist")
    extension = os.path.splitext(launch_file_path)[1].lstrip(".")
    try:
        if extension == "py":
            return get_launch_description_from_python_launch_file(launch_file_path)
        if extension in _MARKUP or _parser(parser).is_filename_valid(launch_file_path):
            return _from_markup(launch_file_path, parser)
        return _from_any(launch_file_path, extension, parser)
    except Exception as error:
        add_location(error, launch_file_path, None)
        raise


def _from_any(launch_file_path: str, extension: str, parser: type[Parser] | None) -> LaunchDescription:
    errors: list[Exception] = []
    loaders: tuple[Callable[[], LaunchDescription], ...] = (
        lambda: _from_markup(launch_file_path, parser),
        lambda: get_launch_description_from_python_launch_file(launch_file_path),
    )
    for load in loaders:
        try:
            return load()
        except (InvalidLaunchFileError, SyntaxError, ValueError) as error:
            errors.append(error)
    raise InvalidLaunchFileError(extension, likely_errors=errors)


def _from_markup(launch_file_path: str, parser: type[Parser] | None) -> LaunchDescription:
    from .frontend_launch_file_utilities import get_launch_description_from_frontend_launch_file

    return get_launch_description_from_frontend_launch_file(launch_file_path, parser=_parser(parser))


def _parser(parser: type[Parser] | None) -> type[Parser]:
    from ..frontend.parser import Parser

    return parser or Parser
