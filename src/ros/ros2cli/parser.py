"""The parser of the command line: commands and verbs that are made when they are chosen."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any, NoReturn

from ros2cli.extensions import Extensions


class Parser(argparse.ArgumentParser):
    """An `ArgumentParser` whose list of subcommands is looked up only to be shown."""

    subcommands: Extensions | None = None
    _group: Any = None
    _hidden: Collection[str] = ()

    def add_subcommands(
        self,
        title: str,
        name: str,
        extensions: Extensions,
        make: Callable[[Any, Parser, str], None],
        *,
        hidden: Collection[str] = (),
        required: bool = False,
    ) -> None:
        """Add subcommands, of which one may be chosen.

        Parameters
        ----------
        title
            The heading above their list in the help.
        name
            What is typed before a subcommand, such as ``ros2 topic``.
        extensions
            The subcommands.
        make
            Completes the parser of a chosen subcommand: ``make(extension, parser, name)``.
        hidden
            Subcommands that the help leaves out.
        required
            Whether one must be given.
        """
        self.formatter_class = argparse.RawDescriptionHelpFormatter  # the list of subcommands has its own lines
        self.subcommands = extensions
        self._hidden = hidden
        hint = f"Call `{name} <command> -h` for more detailed usage."
        action = self.add_subparsers(title=title, description="", metavar=hint, parser_class=Parser)
        action.required = required
        parsers = _Subparsers(name, extensions, make)
        # `choices` and this map are what argparse chooses the parser from.
        action.choices = parsers  # type: ignore[assignment]
        action._name_parser_map = parsers  # type: ignore[assignment]
        self._group = self._action_groups[-1]

    def error(self, message: str) -> NoReturn:
        """Print the usage and what is wrong, with subcommands like an unknown one, and end with status 2."""
        unknown = re.search(r"invalid choice: '([^']*)'", message)
        if self.subcommands is not None and unknown is not None:
            from daidalos.common.suggestions import did_you_mean

            message += did_you_mean(unknown[1], self.subcommands)
        super().error(message)

    def format_help(self) -> str:
        """Return the help, with the list of subcommands."""
        if self.subcommands is not None:
            shown = [name for name in self.subcommands if name not in self._hidden]
            width = max(map(len, shown), default=0)
            lines = (f"{name:<{width}}  {self.subcommands.describe(name)}" for name in shown)
            self._group.description = "\n".join(lines)
        return super().format_help()


class _Subparsers(Mapping[str, Parser]):
    """Parsers of subcommands by name, made when asked for."""

    def __init__(self, name: str, extensions: Extensions, make: Callable[[Any, Parser, str], None]) -> None:
        self._name = name
        self._extensions = extensions
        self._make = make
        self._made: dict[str, Parser] = {}

    def __contains__(self, name: object) -> bool:
        return name in self._extensions

    def __getitem__(self, name: str) -> Parser:
        if name not in self._made:
            extension = self._extensions[name]
            full_name = f"{self._name} {name}"
            parser = Parser(prog=full_name, description=self._extensions.describe(name))
            self._make(extension, parser, full_name)
            self._made[name] = parser
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._extensions)

    def __len__(self) -> int:
        return len(self._extensions)
