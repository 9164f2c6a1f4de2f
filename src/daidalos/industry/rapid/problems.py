"""Problems of a program, as `daidalos rapid check` reports them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Kind = Literal["syntax", "semantic"]


@dataclass(frozen=True, order=True)
class Problem:
    """An error or a warning at one place of a module.

    Attributes
    ----------
    line, column
        From 1; a tab counts as one column.
    message
        What is wrong and, where it is known, what to write instead.
    kind
        ``syntax`` or ``semantic``.
    end_column
        Column behind the last character that is marked, on the same line.
    is_warning
        Whether this is no error.
    runs
        Whether the program can be run nevertheless.
    """

    line: int
    column: int
    message: str
    kind: Kind = "semantic"
    end_column: int = 0
    is_warning: bool = False
    runs: bool = False

    def text(self, file: str) -> str:
        """Return the line that is printed: ``file:line:column: error: message``."""
        word = "warning" if self.is_warning else f"{self.kind} error"
        return f"{file}:{self.line}:{self.column}: {word}: {self.message}"
