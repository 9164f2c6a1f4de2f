"""`ros2 interface show`."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from enum import Enum
from pathlib import Path

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.interface_arguments import add_type_argument
from daidalos.interfaces.definition import PRIMITIVES
from daidalos.interfaces.library import definition_text


class Comments(Enum):
    """Selection of the comments to show."""

    ALL = "all"
    OUTER = "outer"
    NONE = "none"


class ShowVerb(Verb):
    """Output the interface definition."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_type_argument(
            parser,
            "Show an interface definition (e.g. 'std_msgs/msg/String'). Passing '-' reads the argument from stdin "
            "(e.g. 'ros2 topic type /chatter | ros2 interface show -').",
        )
        group = parser.add_mutually_exclusive_group()
        group.add_argument(
            "--all-comments",
            dest="comments",
            action="store_const",
            const=Comments.ALL,
            default=Comments.OUTER,
            help="Show all comments, including for nested interface definitions",
        )
        group.add_argument(
            "--no-comments",
            dest="comments",
            action="store_const",
            const=Comments.NONE,
            help="Show no comments or whitespace",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the definition, with nested types below their fields."""
        print("\n".join(definition_lines(args.type, args.comments)).rstrip())
        return 0


def definition_lines(name: str, comments: Comments, depth: int = 0) -> Iterator[str]:
    """Yield the lines of an interface's definition; nested types follow their field, indented by a tab.

    Raises
    ------
    CliError
        When there is no such interface.
    """
    shown = comments is Comments.ALL or (comments is Comments.OUTER and depth == 0)
    package = name.split("/")[0]
    for line in definition_text(_path(name)).splitlines():
        content = _without_comment(line)
        text = line.rstrip() if shown else content
        if text or shown:
            yield "\t" * depth + text if text else ""
        nested = nested_type(content, package)
        if nested:
            yield from definition_lines(nested, comments, depth + 1)


def nested_type(line: str, package: str) -> str | None:
    """Return the full name of a field's type, None for a primitive type or a line without a field."""
    match = re.match(r"\s*([A-Za-z][\w/]*)(\[[^\]]*\]|<=\d+)*\s+([A-Za-z]\w*)\s*(=?)", line)
    if match is None or match.group(4) or match.group(1) in PRIMITIVES:
        return None
    parts = match.group(1).split("/")
    if parts == ["Header"]:
        return "std_msgs/msg/Header"
    if len(parts) == 3:
        return match.group(1)
    return f"{parts[0] if len(parts) == 2 else package}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """Return a line without its comment; a hash within quotation marks does not start one."""
    match = re.match(r"""(?:[^#"']|"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')*""", line)
    content = match.group() if match else ""
    rest = line[len(content) :]
    return (content if not rest or rest.startswith("#") else line).rstrip()


def _path(name: str) -> Path:
    from ros2cli.interfaces import interface_names
    from rosidl_runtime_py import get_interface_path

    from daidalos.cli.ros2.interface_arguments import KINDS
    from daidalos.common.suggestions import did_you_mean

    try:
        return Path(get_interface_path(name))
    except (LookupError, ValueError) as error:
        known = (other for kind in KINDS for other in interface_names(kind))
        raise CliError(f"{error.args[0]}{did_you_mean(name, known)}") from None
