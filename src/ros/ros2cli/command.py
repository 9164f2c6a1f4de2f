"""Commands that other packages add to `ros2`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from typing import Any, ClassVar, cast

from daidalos.common.extensions import Kind
from ros2cli.extensions import Extensions
from ros2cli.parser import Parser
from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, satisfies_version


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
