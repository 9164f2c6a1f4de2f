"""Contract of commands and verbs, built-in or of other packages.

A package adds a command with an entry point in the group ``ros2cli.command``, and a verb of a command in that
command's group, such as ``ros2topic.verb``. Both are classes with the methods below.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.parser import Parser

COMMAND_GROUP = "ros2cli.command"

Status = int | str | None
"""Result of a command: an exit status, or a message for standard error (then the status is 1)."""


class Verb:
    """Verb of a command, such as ``list`` of ``ros2 topic``; its docstring is its description."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments; `cli_name` is such as ``ros2 topic list``."""

    def main(self, *, args: Namespace) -> Status:
        """Run the verb; return its exit status."""
        raise NotImplementedError


class Command:
    """Command, such as ``ros2 run``; its docstring is its description."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the command's arguments; `cli_name` is such as ``ros2 run``."""

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Run the command; return its exit status."""
        raise NotImplementedError


def make_command(command: Command, parser: Parser, name: str) -> None:
    """Complete the parser of a command."""
    parser.set_defaults(_main=lambda args: command.main(parser=parser, args=args))
    command.add_arguments(parser, name)


def make_verb(verb: Verb, parser: Parser, name: str) -> None:
    """Complete the parser of a verb."""
    parser.set_defaults(_main=lambda args: verb.main(args=args))
    verb.add_arguments(parser, name)
