"""Commands that consist of verbs."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from typing import Any, ClassVar, cast

from ros2cli.extensions import Extensions, built_in
from ros2cli.parser import Parser

from daidalos.cli.ros2.extension import Command, Status, make_verb
from daidalos.common.extensions import Kind


class VerbCommand(Command):
    """Command with verbs; each built-in verb is the class ``<Name>Verb`` in a module of the command's package."""

    group: ClassVar[str]
    """Entry point group of the verbs of other packages."""
    verbs: ClassVar[Mapping[str, str]]
    """Descriptions of the built-in verbs by name."""
    module: ClassVar[str] = ""
    """Package of the built-in verbs' modules; empty for that of the class."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the command's options and its verbs."""
        self.add_options(parser)
        cast(Parser, parser).add_subcommands("Commands", cli_name, self.extensions(), make_verb)

    def add_options(self, parser: ArgumentParser) -> None:
        """Declare options before the verb."""

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Print the help, since no verb was given."""
        parser.print_help()
        return 0

    @classmethod
    def extensions(cls) -> Extensions:
        """Return the built-in verbs and those of other packages."""
        modules = cls.module or cls.__module__
        name = modules.rpartition(".")[2]
        kind: Kind[Any] = Kind(
            f"ros2_{name}_verb",
            cls.group,
            "ros2cli.subcommand:Subcommand",
            f"a verb of `ros2 {name}`",
            lambda: built_in(cls.verbs, modules, "Verb"),
        )
        return Extensions(kind)
