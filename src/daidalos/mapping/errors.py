"""Errors of mapping and of its files."""

from pathlib import Path

from daidalos.common.errors import Location, UserError


class MappingError(UserError):
    """Error of mapping, with a message of one line for the user."""


class MapFileError(MappingError):
    """Error of a map file that cannot be read or written.

    Attributes
    ----------
    path : Path
        The YAML file or the image.
    field : str or None
        The field of the YAML file or the part of the image.
    """

    def __init__(self, path: Path, field: str | None, problem: str) -> None:
        super().__init__(f"{field}: {problem}" if field else problem, Location(str(path)))
        self.path = path
        self.field = field


class LogError(MappingError):
    """Error of a bag that cannot be read or lacks the needed topics.

    Attributes
    ----------
    path : Path
        The bag.
    """

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(problem, Location(str(path)))
        self.path = path


class LineError(MappingError):
    """Error of a line of a text file.

    Attributes
    ----------
    path : Path
        The file.
    line : int or None
        Number of the line, from 1.
    """

    def __init__(self, path: Path, line: int | None, problem: str) -> None:
        super().__init__(problem, Location(str(path), line))
        self.path = path
        self.line = line


class RelationsError(LineError):
    """Error of a file of ground-truth relations."""


class GraphFileError(LineError):
    """Error of a file of a pose graph or a trajectory."""


class LogFileError(LineError):
    """Error of a log in a text format."""
