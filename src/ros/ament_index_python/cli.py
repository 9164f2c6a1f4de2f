"""The command `ament_index`: shows what is registered."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Generator
from typing import Any

from .resources import get_resource, get_resource_types, get_resources


def main(argv: list[str] | None = None) -> str | None:
    """Show resource types, the resources of a type, or one resource.

    Parameters
    ----------
    argv
        The arguments, those of the process if not said.

    Returns
    -------
        An error message, or None.
    """
    parser = argparse.ArgumentParser(description="Query the ament resource index.")
    types = parser.add_argument("resource_type", nargs="?", help="the type of resources to show")
    names = parser.add_argument("resource_name", nargs="?", help="the resource of this type to show")
    # argcomplete's own attribute
    types.completer = resource_type_completer  # type: ignore[attr-defined]
    names.completer = resource_name_completer  # type: ignore[attr-defined]
    _complete(parser)
    args = parser.parse_args(sys.argv[1:] if argv is None else argv)
    try:
        lines = _lines(args.resource_type, args.resource_name)
    except (LookupError, OSError, ValueError) as error:
        return str(error)
    sys.stdout.writelines(f"{line}\n" for line in lines)
    return None


def _lines(resource_type: str | None, resource_name: str | None) -> list[str]:
    if resource_type is None:
        return sorted(get_resource_types())
    if resource_name is None:
        return [f"{name}\t{prefix}" for name, prefix in sorted(get_resources(resource_type).items())]
    content, prefix = get_resource(resource_type, resource_name)
    return [prefix, *([content] if content else [])]


def resource_type_completer(prefix: str | tuple[str, ...], **kwarg: Any) -> Generator[str, None, None]:
    """Yield the resource types that begin with some text, for the shell's completion."""
    return (name for name in get_resource_types() if name.startswith(prefix))


def resource_name_completer(
    prefix: str | tuple[str, ...], parsed_args: argparse.Namespace, **kwargs: Any
) -> Generator[str, None, None] | list[str]:
    """Yield the resources of the type on the command line that begin with some text."""
    resource_type = getattr(parsed_args, "resource_type", None)
    if not resource_type:
        return []
    return (name for name in get_resources(resource_type) if name.startswith(prefix))


def _complete(parser: argparse.ArgumentParser) -> None:
    try:
        import argcomplete
    except ImportError:
        return
    argcomplete.autocomplete(parser, exclude=["-h", "--help"])
