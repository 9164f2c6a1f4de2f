"""Someone who follows a page: types its commands, writes its files, and compares what is printed."""

import time
from collections.abc import Callable
from pathlib import Path

from terminals import TIMEOUT_S, Terminal

from . import pages

_KEYS = {"Up": "\x1b[A", "Down": "\x1b[B", "Right": "\x1b[C", "Left": "\x1b[D", "Space": " ", "Enter": "\n"}
_BETWEEN_LOOKS_S = 0.2
_BETWEEN_KEYS_S = 0.3
_SHOWN_LINES = 40


class Reader:
    """Follows a page in a home folder.

    Parameters
    ----------
    home
        Where files go and terminals begin.
    open_terminal
        Opens a terminal in a folder.
    """

    def __init__(self, home: Path, open_terminal: Callable[[Path], Terminal]) -> None:
        self._home = home
        self._open = open_terminal
        self._terminals: dict[int, Terminal] = {}
        self._interrupted: dict[Terminal, str] = {}
        self.mismatches: list[str] = []

    def follow(self, page: pages.Page) -> None:
        """Do all that the page says; what is not as it says is gathered in `mismatches`."""
        for block in page.blocks:
            where = f"{page.path.name}:{block.line}"
            if block.kind == "file":
                path = self._home / block.title.removeprefix("~/")
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text, encoding="utf-8")
            elif block.kind == "keys":
                self._press(block)
            else:
                for command in block.commands:
                    self._follow_command(page, block.terminal, command, where)

    def _follow_command(self, page: pages.Page, number: int, command: pages.Command | None, where: str) -> None:
        try:
            self._type(page, self._terminal(number), command, where)
        except AssertionError as error:
            error.add_note("\n".join(["Before, this was not as the page says:", *self.mismatches]))
            for other, terminal in self._terminals.items():
                last = terminal.output().splitlines()[-_SHOWN_LINES:]
                error.add_note("\n".join([f"--- terminal {other} ends with", *last]))
            raise

    def close(self) -> None:
        """End all terminals."""
        for terminal in self._terminals.values():
            terminal.close()
        self._terminals.clear()

    def _terminal(self, number: int) -> Terminal:
        if number not in self._terminals:
            self._terminals[number] = self._open(self._home)
        return self._terminals[number]

    def _press(self, block: pages.Block) -> None:
        for key in block.text.split():
            self._terminal(block.terminal).press(_KEYS.get(key, key))
            time.sleep(_BETWEEN_KEYS_S)  # as quick as fingers are

    def _type(self, page: pages.Page, terminal: Terminal, command: pages.Command | None, where: str) -> None:
        if command is None:
            if not terminal.running:
                self.mismatches.append(f"{where}: Ctrl-C, but nothing is running\n")
            else:
                self._interrupted[terminal] = terminal.interrupt()
            return
        if command.text:
            terminal.start(command.text)
        expected, more = pages.pattern(command.expected)
        if not more and command.text:
            printed = _lines(terminal.finish())
            self._compare(page, command, expected.fullmatch(printed), printed)
            return
        if not terminal.running:
            printed = _lines(self._interrupted.get(terminal, ""))
            self._compare(page, command, expected.search(printed), printed)
            return
        looks = expected.match if command.text else expected.search
        end = time.monotonic() + TIMEOUT_S
        while not looks(_lines(terminal.output())) and not terminal.ended() and time.monotonic() < end:
            terminal.wait(_BETWEEN_LOOKS_S)
        printed = _lines(terminal.output())
        self._compare(page, command, looks(printed), printed)
        if command.must_end or terminal.ended():
            terminal.finish()

    def _compare(self, page: pages.Page, command: pages.Command, match: object, printed: str) -> None:
        if match is None:
            expected = "\n".join(command.expected)
            printed = "".join(printed.splitlines(keepends=True)[:_SHOWN_LINES])
            self.mismatches.append(
                f"{page.path.name}:{command.line}: $ {command.text}\n--- the page says\n{expected}\n"
                f"--- it printed\n{printed}"
            )


def _lines(text: str) -> str:
    """Return text with nothing at the ends of its lines, and no empty lines at its end."""
    lines = "\n".join(line.rstrip() for line in text.splitlines()).strip("\n")
    return f"{lines}\n" if lines else ""
