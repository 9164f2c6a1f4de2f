"""Parser of CMakeLists.txt into commands and blocks of commands."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from daidalos.common.errors import Location
from daidalos.workspaces.errors import WorkspaceError

_TOKEN = re.compile(
    r"""
    (?P<comment>\#\[(?P<ceq>=*)\[.*?\](?P=ceq)\] | \#[^\n]*)
  | (?P<space>\s+)
  | (?P<open>\()
  | (?P<close>\))
  | \[(?P<eq>=*)\[\n?(?P<bracket>.*?)\](?P=eq)\]
  | "(?P<quoted>(?:[^"\\]|\\.)*)"
  | (?P<bare>(?:[^\s()\#"\\]|\\.|\$\([^)]*\))+(?:"(?:[^"\\]|\\.)*"(?:[^\s()\#"\\]|\\.)*)*)
    """,
    re.VERBOSE | re.DOTALL,
)
_NAME = re.compile(r"[A-Za-z_]\w*$")
_ENDS = {
    "if": "endif",
    "foreach": "endforeach",
    "while": "endwhile",
    "function": "endfunction",
    "macro": "endmacro",
    "block": "endblock",
}
_STARTS = {end: start for start, end in _ENDS.items()}


@dataclass(frozen=True)
class Argument:
    """Argument as written; `kind` is ``bare``, ``quoted`` or ``bracket``."""

    text: str
    kind: str = "bare"


@dataclass(frozen=True)
class Command:
    """Command with its arguments; nested parentheses are arguments of their own."""

    name: str
    arguments: tuple[Argument, ...]
    line: int


@dataclass
class Block:
    """Commands between ``if``, ``foreach``, ... and their end; an ``if`` has a branch for each condition."""

    kind: str
    branches: list[tuple[Command, list[Node]]] = field(default_factory=list)


Node = Command | Block


def parse(text: str, source: str) -> list[Node]:
    """Return the commands of a file, blocks nested.

    Parameters
    ----------
    text
        What the file holds.
    source
        Its name, for messages.

    Raises
    ------
    WorkspaceError
        Naming `source` and the line that cannot be understood.
    """
    root: list[Node] = []
    open_blocks: list[Block] = []
    bodies = [root]
    for command in _commands(text, source):
        if command.name in _ENDS:
            block = Block(command.name, [(command, [])])
            bodies[-1].append(block)
            open_blocks.append(block)
            bodies.append(block.branches[0][1])
        elif command.name in ("elseif", "else") and open_blocks and open_blocks[-1].kind == "if":
            open_blocks[-1].branches.append((command, []))
            bodies[-1] = open_blocks[-1].branches[-1][1]
        elif command.name in _STARTS or command.name in ("elseif", "else"):
            start = _STARTS.get(command.name, "if")
            if not open_blocks or open_blocks[-1].kind != start:
                raise WorkspaceError(f"{command.name}() without its {start}()", Location(source, command.line))
            open_blocks.pop()
            bodies.pop()
        else:
            bodies[-1].append(command)
    if open_blocks:
        first = open_blocks[-1].branches[0][0]
        raise WorkspaceError(f"{first.name}() has no {_ENDS[first.name]}()", Location(source, first.line))
    return root


def _commands(text: str, source: str) -> Iterator[Command]:
    tokens = list(_tokens(text, source))
    position = 0
    while position < len(tokens):
        kind, name, line = tokens[position]
        if kind != "bare" or not _NAME.match(name):
            raise WorkspaceError(f"expected the name of a command, got '{name}'", Location(source, line))
        if position + 1 == len(tokens) or tokens[position + 1][0] != "open":
            raise WorkspaceError(f"expected '(' after '{name}'", Location(source, line))
        position += 2
        arguments: list[Argument] = []
        depth = 1
        while True:
            if position == len(tokens):
                raise WorkspaceError(f"the '(' after '{name}' is never closed", Location(source, line))
            kind, value, _ = tokens[position]
            position += 1
            depth += {"open": 1, "close": -1}.get(kind, 0)
            if depth == 0:
                break
            arguments.append(Argument(value, "bare" if kind in ("open", "close") else kind))
        yield Command(name.lower(), tuple(arguments), line)


def _tokens(text: str, source: str) -> Iterator[tuple[str, str, int]]:
    position = 0
    line = 1
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            what = "a quoted text is never closed" if text[position] == '"' else f"unexpected '{text[position]}'"
            raise WorkspaceError(what, Location(source, line))
        for kind in ("open", "close", "bracket", "quoted", "bare"):
            value = match.group(kind)
            if value is not None:
                yield kind, value, line
        line += match.group().count("\n")
        position = match.end()
