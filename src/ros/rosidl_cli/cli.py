"""Program `rosidl`."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence

from rosidl_cli.command import Command
from rosidl_cli.command.generate import GenerateCommand
from rosidl_cli.command.translate import TranslateCommand
from rosidl_cli.common import get_first_line_doc


def add_subparsers(parser: argparse.ArgumentParser, cli_name: str, commands: Sequence[Command]) -> None:
    """Add a parser for each command, which becomes `_command` of the arguments.

    Parameters
    ----------
    parser
        The program's parser.
    cli_name
        The program's name.
    commands
        The commands.
    """
    commands = sorted(commands, key=lambda command: command.name)
    width = max(len(command.name) for command in commands)
    lines = [f"{command.name:{width}}  {get_first_line_doc(command)}" for command in commands]
    subparsers = parser.add_subparsers(
        title="Commands",
        description="\n".join(lines),
        metavar=f"Call `{cli_name} <command> -h` for more detailed usage.",
        dest="_command",
        required=True,
    )
    for command in commands:
        subparser = subparsers.add_parser(command.name, description=get_first_line_doc(command))
        subparser.set_defaults(_command=command)
        command.add_arguments(subparser)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program and return its exit status."""
    parser = argparse.ArgumentParser(
        prog="rosidl",
        description="rosidl is an extensible command-line tool for ROS interface generation.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_subparsers(parser, "rosidl", [GenerateCommand(), TranslateCommand()])
    args = parser.parse_args(argv)
    try:
        args._command.main(args=args)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    except (OSError, RuntimeError, ValueError) as error:
        print(f"rosidl {args._command.name}: {error}", file=sys.stderr)  # noqa: T201
        return 1
    return 0
