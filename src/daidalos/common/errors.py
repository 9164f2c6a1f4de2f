"""Errors of the user, with their location in a file."""

from __future__ import annotations

from typing import NamedTuple


class Location(NamedTuple):
    """Location in a file that an error message names.

    Attributes
    ----------
    file : str or None
        Path of the file; None where the value came from no file.
    line : int or None
        Line in the file, from 1; None where it is not known.
    name : str
        Parameter, element or argument at that place, such as ``FollowPath.plugin``; empty where there is none.
    """

    file: str | None = None
    line: int | None = None
    name: str = ""

    def __str__(self) -> str:
        """Return ``file:line``, the file alone, or nothing, as far as they are known."""
        return ":".join(str(part) for part in (self.file, self.line if self.file else None) if part is not None)

    def prefix(self) -> str:
        """Return the prefix of a message: ``file:line: 'name': ``, as far as they are known."""
        return "".join(f"{part}: " for part in (str(self), f"'{self.name}'" if self.name else "") if part)


class UserError(Exception):
    """Error of the user, shown as one line without a traceback.

    Parameters
    ----------
    problem : str
        What is wrong, and what was expected.
    location : Location, optional
        Where it was written; the message begins with it.
    """

    def __init__(self, problem: str, location: Location | None = None) -> None:
        super().__init__(f"{_visible(location.prefix()) if location else ''}{_visible(problem)}")
        self.location = location


def _visible(text: str) -> str:
    """Return a text without what a terminal would obey or show as a line break: a message repeats what a file holds."""
    if text.isprintable():
        return text
    return "".join(one if one.isprintable() or one in "\n\t" else ascii(one)[1:-1] for one in text)
