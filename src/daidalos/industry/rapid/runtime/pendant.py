"""The operator's screen of a program."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Protocol

from daidalos.industry.rapid.runtime.errors import RapidError


class Pendant(Protocol):
    """Where a program writes lines and asks for numbers, keys and texts."""

    def write(self, text: str) -> None:
        """Show a line."""
        ...

    def erase(self) -> None:
        """Clear the screen."""
        ...

    def ask(self, text: str, choices: Sequence[str] = ()) -> str:
        """Ask for a line of text; with choices, for one of them."""
        ...


class TextPendant:
    """Screen of lines: those of a terminal, or of other functions.

    Parameters
    ----------
    read
        Returns the operator's next line, given a prompt; raises EOFError at the end.
    show
        Shows a line.
    """

    def __init__(self, read: Callable[[str], str] | None = None, show: Callable[[str], None] | None = None) -> None:
        self._read = read if read is not None else input
        self._show = show if show is not None else _show
        self.lines: list[str] = []

    def write(self, text: str) -> None:
        """Show a line."""
        self.lines.append(text)
        self._show(text)

    def erase(self) -> None:
        """Forget the lines; a terminal keeps what it has shown."""
        self.lines.clear()

    def ask(self, text: str, choices: Sequence[str] = ()) -> str:
        """Ask for a line of text; with choices, for the number of one of them.

        Raises
        ------
        RapidError
            ERR_TP_NO_CLIENT, where nobody answers.
        """
        shown = "  ".join(f"[{index}] {one}" for index, one in enumerate(choices, 1) if one)
        try:
            return self._read(f"{text} {shown}: " if shown else f"{text}: ").strip()
        except EOFError:
            raise RapidError("ERR_TP_NO_CLIENT", "nobody answers at the pendant") from None


def _show(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
