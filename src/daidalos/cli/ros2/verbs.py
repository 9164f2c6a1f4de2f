"""Commands that consist of verbs."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from importlib import import_module
from typing import ClassVar, cast

from ros2cli.extensions import Extensions
from ros2cli.parser import Parser

from daidalos.cli.ros2.extension import Command, Status, Verb, make_verb


class VerbCommand(Command):
    """A command with verbs; each built-in one is the class ``<Name>Verb`` in a module of the command's package."""

    group: ClassVar[str]
    """The group of entry points by which other packages add verbs."""
    verbs: ClassVar[Mapping[str, str]]
    """Descriptions of the built-in verbs by name."""
    module: ClassVar[str] = ""
    """The package of the built-in verbs' modules; that of the class where empty."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the command's options and its verbs."""
        self.add_options(parser)
        cast(Parser, parser).add_subcommands("Commands", cli_name, self.extensions(), make_verb)

    def add_options(self, parser: ArgumentParser) -> None:
        """Declare options that stand before the verb."""

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Show the help: no verb was given."""
        parser.print_help()
        return 0

    @classmethod
    def extensions(cls) -> Extensions:
        """Return the verbs, built-in and added."""
        return Extensions(cls.group, cls.verbs, cls._load)

    @classmethod
    def _load(cls, name: str) -> Verb:
        module = import_module(f"{cls.module or cls.__module__}.{name}")
        verb: Verb = getattr(module, class_name(name, "Verb"))()
        return verb


def class_name(name: str, suffix: str) -> str:
    """``send_goal`` -> ``SendGoalVerb``."""
    return "".join(part.capitalize() for part in name.split("_")) + suffix
