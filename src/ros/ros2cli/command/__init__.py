"""Commands of `ros2`, and the choice of their verbs."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, ClassVar, cast

from daidalos.common.extensions import Kind
from ros2cli.entry_points import get_first_line_doc
from ros2cli.extensions import Extensions
from ros2cli.parser import Parser
from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, instantiate_extensions, satisfies_version


class CommandExtension:
    """The base of commands: entry points of the group ``ros2cli.command``; the docstring is the description."""

    NAME: ClassVar[str | None] = None
    EXTENSION_POINT_VERSION = "0.1"

    def __init__(self) -> None:
        satisfies_version(PLUGIN_SYSTEM_VERSION, "^0.1")

    def add_arguments(self, parser: ArgumentParser, cli_name: str, *, argv: Sequence[str] | None = None) -> None:
        """Declare the command's arguments; `cli_name` is such as ``ros2 greet``."""

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Any:
        """Run it, and return the exit status, or a message for standard error."""
        raise NotImplementedError


def get_command_extensions(group_name: str, *, exclude_names: Iterable[str] | None = None) -> dict[str, Any]:
    """Return an object of each command of a group of entry points, by name.

    Parameters
    ----------
    group_name
        The group, such as ``ros2cli.command``.
    exclude_names
        Names to leave out.
    """
    extensions = instantiate_extensions(group_name, exclude_names=exclude_names)
    for name, extension in extensions.items():
        extension.NAME = name
    return extensions


def add_subparsers(
    parser: ArgumentParser,
    cli_name: str,
    dest: str,
    command_extensions: Mapping[str, Any],
    hide_extensions: Collection[str] | None = None,
    required: bool = True,
) -> Any:
    """Add subcommands whose objects are there already, and return argparse's action.

    `add_subparsers_on_demand` constructs only the one that is chosen.

    Parameters
    ----------
    parser
        The command's parser.
    cli_name
        What is typed before a subcommand, such as ``ros2 greet``.
    dest
        The attribute of the parsed arguments that holds the chosen subcommand.
    command_extensions
        The subcommands by name.
    hide_extensions
        Subcommands that the help leaves out.
    required
        Whether one must be given.
    """
    hidden = hide_extensions or ()
    documented = {name: get_first_line_doc(one) for name, one in sorted(command_extensions.items())}
    shown = {name: text for name, text in documented.items() if name not in hidden}
    width = max(map(len, shown), default=0)
    action = parser.add_subparsers(
        title="Commands",
        description="\n".join(f"{name:<{width}}  {text}" for name, text in shown.items()),
        metavar=f"Call `{cli_name} <command> -h` for more detailed usage.",
    )
    action.dest = f" {dest.lstrip('_')}"
    action.required = required
    for name, description in documented.items():
        subparser = action.add_parser(
            name, description=description, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        extension = command_extensions[name]
        subparser.set_defaults(**{dest: extension})
        if hasattr(extension, "add_arguments"):
            extension.add_arguments(subparser, f"{cli_name} {name}")
    return action


def add_subparsers_on_demand(
    parser: ArgumentParser,
    cli_name: str,
    dest: str,
    group_name: str,
    hide_extensions: Sequence[str] | None = None,
    required: bool = True,
    argv: Sequence[str] | None = None,
) -> None:
    """Add the verbs of a group of entry points to a command, each imported when it is chosen.

    Parameters
    ----------
    parser
        The command's parser, as its `add_arguments` got it.
    cli_name
        What is typed before a verb, such as ``ros2 greet``.
    dest
        The attribute of the parsed arguments that holds the chosen verb.
    group_name
        The group of entry points, such as ``ros2greet.verb``.
    hide_extensions
        Verbs that the help leaves out.
    required
        Whether the command needs a verb.
    argv
        Of no use, as verbs are made when the arguments are parsed.
    """

    def make(verb: Any, subparser: Parser, name: str) -> None:
        subparser.set_defaults(**{dest: verb})
        verb.add_arguments(subparser, name)

    verbs = Extensions(Kind(group_name, group_name, "ros2cli.subcommand:Subcommand", f"a verb of `{cli_name}`"))
    cast(Parser, parser).add_subcommands(
        "Commands", cli_name, verbs, make, hidden=hide_extensions or (), required=required
    )
