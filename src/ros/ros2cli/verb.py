"""Verbs that other packages add to commands."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any, ClassVar

from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, satisfies_version


class VerbExtension:
    """The base of verbs: entry points of a group such as ``ros2topic.verb``; the docstring is the description."""

    NAME: ClassVar[str | None] = None
    EXTENSION_POINT_VERSION = "0.1"

    def __init__(self) -> None:
        satisfies_version(PLUGIN_SYSTEM_VERSION, "^0.1")

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments; `cli_name` is such as ``ros2 topic list``."""

    def main(self, *, args: Namespace) -> Any:
        """Run it, and return the exit status, or a message for standard error."""
        raise NotImplementedError
