"""`daidalos extensions`: types of extensions, available extensions and their origins."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any

from daidalos.common.extensions import Extension, Kind, listing
from daidalos.common.suggestions import hint

EPILOG = """Packages add extensions by entry points of a kind's group; a class can also be named by its path,
my_package.my_module.MyClass, wherever a name is expected."""

_DECLARED_IN = (
    "daidalos.simulation.extensions",
    "daidalos.control.extensions",
    "daidalos.navigation.extensions",
    "daidalos.industry.assistance.extensions",
    "daidalos.industry.servoing.extensions",
    "daidalos.industry.grinding.extensions",
    "daidalos.studio.extensions",
    "daidalos.nodes.extensions",
)


class ExtensionsVerb:
    """List what can be extended, and the extensions that are there."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos extensions`."""
        parser.epilog = EPILOG
        parser.add_argument(
            "kind", nargs="?", metavar="KIND", help="such as planner; without one, all kinds are listed"
        )
        parser.add_argument("--json", action="store_true", help="print one JSON object")

    def main(self, *, args: argparse.Namespace) -> int:
        """Print the types, or the extensions of one type; return the exit status."""
        known = {kind.name: kind for kind in kinds()}
        if args.kind is None:
            found: dict[str, list[Extension]] = {name: listing(kind) for name, kind in known.items()}
            print(_as_json(known, found)) if args.json else _print_kinds(known, found)
            return 0
        name = _singular(args.kind.replace("-", "_"), known)
        if name not in known:
            help_text = hint(name, known) or "; 'daidalos extensions' lists all kinds"
            print(f"daidalos extensions: there is no kind '{args.kind}'{help_text}", file=sys.stderr)
            return 2
        extensions = listing(known[name])
        print(_as_json(known, {name: extensions})) if args.json else _print_extensions(known[name], extensions)
        return 0


def kinds() -> Iterator[Kind[Any]]:
    """Yield all types of extensions, those of the lowest layer first."""
    for module in _DECLARED_IN:
        yield from import_module(module).KINDS
    from daidalos.cli.daidalos.program import VERBS
    from daidalos.cli.ros2.groups import groups

    yield VERBS
    yield from (extensions.kind for extensions in groups().values())


def _singular(name: str, known: dict[str, Kind[Any]]) -> str:
    """Return the type of a plural name such as ``planners``."""
    return name.removesuffix("s") if name not in known and name.removesuffix("s") in known else name


def _as_json(known: dict[str, Kind[Any]], found: dict[str, list[Extension]]) -> str:
    return json.dumps(
        {
            name: {
                "description": known[name].description,
                "group": known[name].group,
                "contract": known[name].contract,
                "extensions": [
                    {"name": one.name, "aliases": one.names[1:], "class": one.target, "origin": one.origin}
                    for one in extensions
                ],
            }
            for name, extensions in found.items()
        },
        indent=2,
    )


def _print_kinds(known: dict[str, Kind[Any]], found: dict[str, list[Extension]]) -> None:
    rows = [(name, str(len(found[name])), known[name].group, known[name].description) for name in known]
    _print_table("kinds of extensions", ("kind", "known", "group of entry points", "what it is"), rows)


def _print_extensions(kind: Kind[Any], extensions: list[Extension]) -> None:
    rows = [("\n".join(one.names), one.target, one.origin) for one in extensions]
    _print_table(f"{kind.name}: {kind.description}", ("name", "class", "from"), rows)
    print(f"entry points: {kind.group}    contract: {kind.contract}")


def _print_table(title: str, headings: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> None:
    """Print a table; columns are never truncated, so that names can be copied."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table

    table = Table(title=title, box=SIMPLE_HEAD, title_justify="left")
    for heading in headings:
        table.add_column(heading, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console = Console()
    console.print(table) if console.is_terminal else Console(width=1000).print(table)
