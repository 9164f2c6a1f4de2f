"""`ros2 interface`."""

from argparse import Action, ArgumentParser
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from daidalos.cli.ros2.completion import complete
from daidalos.cli.ros2.verbs import VerbCommand

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


class InterfaceCommand(VerbCommand):
    """Show information about ROS interfaces."""

    group = "ros2interface.verb"
    verbs: ClassVar = {
        "list": "List all interface types available",
        "package": "Output a list of available interface types within one package",
        "packages": "Output a list of packages that provide interfaces",
        "proto": "Output an interface prototype",
        "show": "Output the interface definition",
    }


def add_kind_arguments(parser: ArgumentParser, what: str) -> None:
    """Declare the options that ask for interfaces of one kind only."""
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
    """Return the interfaces (``msg/Name`` by package) of a kind, all where None."""
    if kind is None:
        return dict(found)
    selected = {package: [name for name in names if name.startswith(f"{kind}/")] for package, names in found.items()}
    return {package: names for package, names in selected.items() if names}


class TypeOrStdin(Action):
    """Takes a type, or reads it from standard input when it is a dash."""

    def __call__(
        self, parser: ArgumentParser, namespace: Any, values: str | Sequence[Any] | None, option: str | None = None
    ) -> None:
        """Store it."""
        import sys

        if values == "-":
            if sys.stdin.isatty():
                parser.error("expected stdin pipe")
            values = sys.stdin.readline().strip()
        setattr(namespace, self.dest, values)


def add_type_argument(parser: ArgumentParser, what: str) -> None:
    """Declare the argument that names an interface."""

    def names(**_: Any) -> list[str]:
        from daidalos.cli.ros2.interfaces import interface_names

        return [name for kind in KINDS for name in interface_names(kind)]

    complete(parser.add_argument("type", action=TypeOrStdin, help=what), names)
