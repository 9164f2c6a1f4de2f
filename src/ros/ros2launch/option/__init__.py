"""Options that other packages add to `ros2 launch`: entry points of the group ``ros2launch.option``."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Iterable
from typing import Any, ClassVar

from launch import LaunchDescription
from ros2cli.plugin_system import instantiate_extensions, satisfies_version


class OptionExtension:
    """Base of options; the docstring is the description."""

    NAME: ClassVar[str | None] = None
    EXTENSION_POINT_VERSION = "0.1"

    def __init__(self) -> None:
        satisfies_version(self.EXTENSION_POINT_VERSION, "^0.1")

    def add_arguments(self, parser: ArgumentParser, cli_name: str, *, argv: Any = None) -> None:
        """Declare the arguments of the option."""

    def prestart(self, args: Namespace) -> None:
        """Act before the launch service is made."""

    def prelaunch(self, launch_description: LaunchDescription, args: Namespace) -> tuple[LaunchDescription, ...]:
        """Return the launch description, changed or not, as the only item of a tuple."""
        return (launch_description,)

    def postlaunch(self, launch_return_code: int, args: Namespace) -> None:
        """Act after all processes have ended."""


def get_option_extensions(exclude_names: Iterable[str] | None = None) -> dict[str, Any]:
    """Return an object of each option by name."""
    extensions = instantiate_extensions("ros2launch.option", exclude_names=exclude_names)
    for name, extension in extensions.items():
        extension.NAME = name
    return extensions
