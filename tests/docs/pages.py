"""Pages with commands, read as someone would who follows them.

A page is Markdown. These fenced blocks have a meaning for the tests:

``console``
    Lines that begin with ``$`` are typed; what follows is what they print. ``title="Terminal 2"`` says where; without
    it, that is terminal 1. A line ``^C`` stands for Ctrl-C, a line ``...`` for any lines, and ``…`` for any text in
    a line. A command whose output ends with ``...`` may keep running, until Ctrl-C or another command in the same
    terminal, which waits for its end. A block that begins without ``$`` shows what it has printed since then; lines
    after ``^C``, what it has printed by its end.
``text title="Keys in terminal 2"``
    Keys that are pressed, one word each: a letter, or ``Up``, ``Down``, ``Left``, ``Right``, ``Space``,
    ``Enter``.
any other with a path as its title
    A file with this text, relative to the home folder; it is written when the reader gets there.

``<!-- needs program -->`` names what a machine must have, ``<!-- continues page -->`` the page in whose home folder it
goes on.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

_FENCE = re.compile(
    r"^(?P<indent> *)```(?P<language>\w+)(?: +title=\"(?P<title>[^\"]*)\")?[^\n]*\n(?P<body>.*?)^ *```$", re.M | re.S
)
_NEEDS = re.compile(r"<!-- needs (?P<program>\S+) -->")
_CONTINUES = re.compile(r"<!-- continues (?P<page>\S+) -->")
_TERMINAL = re.compile(r"terminal (\d+)", re.IGNORECASE)


@dataclass
class Command:
    """A command that is typed, and the lines that it should print; without text, it is the one that is running."""

    text: str
    line: int
    expected: list[str] = field(default_factory=list)
    must_end: bool = False


@dataclass
class Block:
    """What the reader does next: ``commands`` (a None among them is Ctrl-C), ``keys`` or ``file``."""

    kind: str
    title: str
    line: int
    commands: list[Command | None] = field(default_factory=list)
    text: str = ""

    @property
    def terminal(self) -> int:
        """The number of the terminal that this happens in."""
        match = _TERMINAL.search(self.title)
        return int(match[1]) if match else 1


@dataclass
class Page:
    """The blocks of a page, a program that the machine must have, and the page that comes before it."""

    path: Path
    blocks: list[Block]
    needs: str | None
    continues: str | None


def read(path: Path) -> Page:
    """Read a page."""
    text = path.read_text(encoding="utf-8")
    blocks = []
    for match in _FENCE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        block = _block(match["language"], match["title"] or "", _dedent(match["body"], len(match["indent"])), line)
        if block is not None:
            blocks.append(block)
    _mark_ends(blocks)
    needs, continues = _NEEDS.search(text), _CONTINUES.search(text)
    return Page(path, blocks, needs["program"] if needs else None, continues["page"] if continues else None)


def _mark_ends(blocks: list[Block]) -> None:
    """Mark commands that are followed by another one in the same terminal: they are waited for."""
    latest: dict[int, Command | None] = {}
    for block in blocks:
        if block.kind == "keys":
            latest[block.terminal] = None
        for command in block.commands:
            before = latest.get(block.terminal)
            if before is not None and command is not None and command.text:
                before.must_end = True
            latest[block.terminal] = command


def _dedent(body: str, width: int) -> str:
    return "".join(line[width:] if line.strip() else "\n" for line in body.splitlines(keepends=True))


def _block(language: str, title: str, body: str, line: int) -> Block | None:
    if language == "console":
        return Block("commands", title, line, commands=_commands(body, line))
    if title.lower().startswith("keys"):
        return Block("keys", title, line, text=body)
    if title and " " not in title:
        return Block("file", title, line, text=body)
    return None


def _commands(body: str, first: int) -> list[Command | None]:
    commands: list[Command | None] = []
    continued = False
    for number, line in enumerate(body.splitlines(), first + 1):
        if continued:
            commands[-1].text += "\n" + line.removeprefix("> ")
        elif line.startswith("$ "):
            commands.append(Command(line[2:], number))
        elif line == "^C":
            commands.append(None)
        elif commands and commands[-1] is not None:
            commands[-1].expected.append(line)
            continue
        else:
            commands.append(Command("", number, [line]))
            continue
        continued = line.endswith("\\")
    return commands


_TIMESTAMP = re.compile(r"\[\d{9,}\.\d+\]")


def pattern(expected: list[str]) -> tuple[re.Pattern[str], bool]:
    """Return what output has to match, and whether more may come after it."""
    lines = [line.rstrip() for line in expected]
    while lines and not lines[-1]:
        lines.pop()
    more = bool(lines) and lines[-1] == "..."
    if more:
        lines.pop()
    parts = [r"(?:.*\n)*?" if line == "..." else _line_pattern(line) + r"[ \t]*\n" for line in lines]
    return re.compile("".join(parts)), more


def _line_pattern(line: str) -> str:
    """Return the pattern of a line; how wide columns are set apart is no matter."""
    indent = line[: len(line) - len(line.lstrip())]
    pieces = [re.escape(piece) for piece in _TIMESTAMP.sub("[…]", line.lstrip()).split("…")]
    return re.escape(indent) + re.sub(r"(?:\\ |\\\t)+", r"[ \\t]+", ".*".join(pieces))
