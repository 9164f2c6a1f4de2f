"""Printed lists of the graph: names, types or counts."""

from __future__ import annotations

import sys
from argparse import SUPPRESS, ArgumentParser
from collections.abc import Collection

from ros2cli.graph import NamesAndTypes

from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.graph import types_of
from daidalos.common.suggestions import did_you_mean


def add_count_argument(parser: ArgumentParser, kind: str) -> None:
    """Declare the option to print a number only; `kind` is such as ``topics``."""
    parser.add_argument(
        "-c", f"--count-{kind}", action="store_true", help=f"Only display the number of {kind} discovered"
    )


def add_hidden_argument(parser: ArgumentParser, kind: str) -> None:
    """Declare the option to include what is hidden; `kind` is such as ``topics``.

    The command has the same option before the verb; a default of the verb's would undo it.
    """
    parser.add_argument(
        f"--include-hidden-{kind}", action="store_true", default=SUPPRESS, help=f"Consider hidden {kind} as well"
    )


def print_names(names: Collection[str], *, count: bool) -> None:
    """Print names, or their number."""
    if count:
        print(len(names))
        return
    for name in names:
        print(name)


def print_found(found: NamesAndTypes, *, show_types: bool, count: bool) -> None:
    """Print names, with their types on request, or their number."""
    print_names([f"{name} [{', '.join(types)}]" if show_types else name for name, types in found], count=count)


def print_types(found: NamesAndTypes, name: str, kind: str) -> Status:
    """Print the types of a name; if there are none, print suggestions and return 1.

    `kind` is what the names are, such as ``topic``.
    """
    types = types_of(found, name)
    for one in types:
        print(one)
    if not types:
        sys.stderr.write(f"Unknown {kind} '{name}'{did_you_mean(name, (other for other, _ in found))}\n")
    return 0 if types else 1
