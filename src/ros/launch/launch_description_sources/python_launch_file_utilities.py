"""The way from a launch file in Python to its launch description."""

from __future__ import annotations

import types

from ..invalid_launch_file_error import InvalidLaunchFileError
from ..launch_description import LaunchDescription
from ..launch_file_error import register_launch_file

_MODULE_NAME = "python_launch_file"


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A launch file in Python does not do what it must."""

    def __str__(self) -> str:
        return str(self.args[0])


def load_python_launch_file_as_module(python_launch_file_path: str) -> types.ModuleType:
    """Run a launch file in Python and return it as a module.

    Nothing is written beside the file, and the module is not among those that can be imported.
    """
    with open(python_launch_file_path, "rb") as file:
        source = file.read()
    code = compile(source, python_launch_file_path, "exec", dont_inherit=True)
    register_launch_file(python_launch_file_path)
    module = types.ModuleType(_MODULE_NAME)
    module.__file__ = python_launch_file_path
    exec(code, module.__dict__)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """Run a launch file in Python and return what its `generate_launch_description` returns.

    Raises
    ------
    InvalidPythonLaunchFileError
        If the file has no such function, or if the function returns something else.
    """
    module = load_python_launch_file_as_module(python_launch_file_path)
    generate = getattr(module, "generate_launch_description", None)
    if not callable(generate):
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}' does not contain the required function "
            "'generate_launch_description()'"
        )
    description: LaunchDescription | None = generate()
    if description is None:
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}': 'generate_launch_description()' returned nothing"
        )
    return description
