"""Verbs of commands, built-in and of other packages."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any, ClassVar

from ros2cli import built_in_verbs
from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, instantiate_extensions, satisfies_version

built_in_verbs.register()


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


def get_verb_extensions(name: str) -> dict[str, Any]:
    """Return an object of each verb of a group of entry points, such as ``ros2topic.verb``, by name."""
    extensions = instantiate_extensions(name)
    for verb, extension in extensions.items():
        extension.NAME = verb
    return extensions


def add_task_arguments(parser: ArgumentParser, task_name: str) -> None:
    """Declare the arguments of a task that the extensions of the group of its name have.

    Parameters
    ----------
    parser
        The parser that gets them.
    task_name
        Name of the task and of the group; an extension declares them in ``add_<task_name>_arguments(group)``.
    """
    for name, extension in get_verb_extensions(task_name).items():
        declare = getattr(extension, f"add_{task_name}_arguments", None)
        group = parser.add_argument_group(title=f"Arguments for '{name}' packages")
        if declare is not None:
            declare(group)
