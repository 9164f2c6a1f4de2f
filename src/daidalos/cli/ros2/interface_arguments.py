"""Common arguments of the verbs of `ros2 interface`."""

from __future__ import annotations

import sys
from argparse import Action, ArgumentParser
from collections.abc import Mapping, Sequence
from typing import Any

from daidalos.cli.ros2.completion import complete

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_kind_arguments(parser: ArgumentParser, what: str) -> None:
    """Declare the options that select interfaces of one type."""
    group = parser.add_mutually_exclusive_group()
    for kind, name in (("msg", "message"), ("srv", "service"), ("action", "action")):
        group.add_argument(
            f"-{kind[0]}",
            f"--only-{kind}s",
            dest="kind",
            action="store_const",
            const=kind,
            help=f"Print out only the {what.format(name)}",
        )


def wanted(found: Mapping[str, list[str]], kind: str | None) -> dict[str, list[str]]:
    """Return the interfaces (``msg/Name`` by package) of a type, all for None."""
    if kind is None:
        return dict(found)
    selected = {package: [name for name in names if name.startswith(f"{kind}/")] for package, names in found.items()}
    return {package: names for package, names in selected.items() if names}


class TypeOrStdin(Action):
    """Argument that reads a type from standard input when it is a dash."""

    def __call__(
        self, parser: ArgumentParser, namespace: Any, values: str | Sequence[Any] | None, option: str | None = None
    ) -> None:
        """Store the argument."""
        if values == "-":
            if sys.stdin.isatty():
                parser.error("expected stdin pipe")
            values = sys.stdin.readline().strip()
        setattr(namespace, self.dest, values)


def add_type_argument(parser: ArgumentParser, what: str) -> None:
    """Declare the argument of an interface."""

    def names(**_: Any) -> list[str]:
        from ros2cli.interfaces import interface_names

        return [name for kind in KINDS for name in interface_names(kind)]

    complete(parser.add_argument("type", action=TypeOrStdin, help=what), names)
