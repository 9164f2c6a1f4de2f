"""Printed lists of the graph: names, types or counts."""

from __future__ import annotations

import sys
from collections.abc import Collection

from ros2cli.graph import NamesAndTypes

from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.graph import types_of
from daidalos.common.suggestions import hint_line


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


def print_types(found: NamesAndTypes, name: str) -> Status:
    """Print the types of a name; if there are none, print suggestions and return 1."""
    types = types_of(found, name)
    for one in types:
        print(one)
    if not types:
        sys.stderr.write(hint_line(name, (other for other, _ in found)))
    return 0 if types else 1
