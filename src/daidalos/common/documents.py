"""Reader of YAML files that may come from anywhere: one line for whatever is wrong, and limits on their size."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import Location, UserError

if TYPE_CHECKING:
    from collections.abc import Iterable

MAX_BYTES = 64 << 20
MAX_DEPTH = 100
"""Lists and mappings, or XML elements, within each other; Python's recursion limit allows some hundreds."""
MAX_NODES = 1_000_000
"""Values of a document, counted as often as they occur once aliases are replaced by what they stand for."""

TOO_DEEP = f"more than {MAX_DEPTH} levels within each other"
_LONG = 1 << 16
"""Characters from which on the reader in C is used, whose messages are terser."""


class DocumentError(UserError, ValueError):
    """A document that cannot be read.

    Parameters
    ----------
    problem : str
        What is wrong.
    source : str, optional
        The file.
    line, column : int, optional
        Where, from 1.
    """

    def __init__(
        self, problem: str, source: str | None = None, line: int | None = None, column: int | None = None
    ) -> None:
        super().__init__(problem, Location(source, line))
        self.problem = problem
        self.line = line
        self.column = column

    @property
    def described(self) -> str:
        """The problem with its line and column, without the file's name."""
        return self.problem if self.line is None else f"line {self.line}, column {self.column or 1}: {self.problem}"


def read_text(path: Path | str) -> str:
    """Return the text of a file in UTF-8.

    Raises
    ------
    DocumentError
        When it is larger than `MAX_BYTES`, not UTF-8, or no file can have its name.
    OSError
        When it cannot be opened.
    """
    try:
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except ValueError:  # a zero or a lone surrogate
        raise DocumentError("is a name that no file can have", ascii(str(path))) from None
    if len(data) > MAX_BYTES:
        raise DocumentError(f"is larger than {MAX_BYTES >> 20} MiB", str(path))
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - data.rfind(b"\n", 0, error.start)
        raise DocumentError("is not valid UTF-8", str(path), line, column) from None


def read_yaml(path: Path | str) -> Any:
    """Return the content of a YAML file; see `parse_yaml` and `read_text`."""
    return parse_yaml(read_text(path), str(path))


def parse_json(text: str, source: str | None = None) -> Any:
    """Return the content of a JSON document.

    Raises
    ------
    DocumentError
        When it is not valid, is nested too deeply, or holds a number that is none or far too long.
    """
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise DocumentError(f"is not valid JSON: {error.msg}", source, error.lineno, error.colno) from None
    except (ValueError, RecursionError) as error:
        raise DocumentError(f"is not valid JSON: {error}", source) from None


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number of JSON")


def parse_yaml(text: str, source: str | None = None, loader: Any = None, *, aliases: bool = True) -> Any:
    """Return the content of a YAML document.

    Parameters
    ----------
    text : str
    source : str, optional
        The file's name for errors.
    loader : yaml loader class, or function that makes one of a text, optional
        PyYAML's safe loader where None.
    aliases : bool
        Whether ``*name`` may stand for another value.

    Raises
    ------
    DocumentError
        When it is not valid, is nested too deeply, or expands to too much.
    """
    import yaml

    fast = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    chosen: Any = loader or (fast if len(text) > _LONG else yaml.SafeLoader)
    try:
        _check_events(yaml.parse(text, fast if chosen is fast else yaml.SafeLoader), yaml, source, aliases)
        return yaml.load(text, chosen)
    except yaml.reader.ReaderError as error:
        character: Any = error.character
        number = character if isinstance(character, int) else ord(character)
        line = text.count("\n", 0, max(error.position, 0)) + 1
        column = error.position - text.rfind("\n", 0, max(error.position, 0))
        raise DocumentError(f"the character #x{number:04x} is not allowed", source, line, column) from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = " ".join((error.problem or error.context or "is not valid YAML").split())
        raise DocumentError(problem, source, *((mark.line + 1, mark.column + 1) if mark else ())) from None
    except DocumentError:
        raise
    except RecursionError:
        raise DocumentError(TOO_DEEP, source) from None
    except (yaml.YAMLError, ValueError, TypeError, ArithmeticError) as error:  # such as a month 13, a list as a key
        raise DocumentError(" ".join(str(error).split()) or "is not valid YAML", source) from None
    except (AttributeError, LookupError):  # such as !!int without digits, or !!bool of a word
        raise DocumentError("a value does not fit its tag", source) from None


def _check_events(events: Iterable[Any], yaml: Any, source: str | None, aliases: bool) -> None:
    """Check the depth of a document, and how many values it has once aliases are replaced."""
    sizes: dict[str, int] = {}
    stack: list[tuple[str | None, int]] = []
    total = 0
    for event in events:
        problem = None
        if isinstance(event, yaml.MappingStartEvent | yaml.SequenceStartEvent):
            stack.append((event.anchor, total))
            total += 1
            problem = TOO_DEEP if len(stack) > MAX_DEPTH else None
        elif isinstance(event, yaml.MappingEndEvent | yaml.SequenceEndEvent):
            anchor, before = stack.pop()
            if anchor is not None:
                sizes[anchor] = total - before
        elif isinstance(event, yaml.ScalarEvent):
            total += 1
            if event.anchor is not None:
                sizes[event.anchor] = 1
        elif isinstance(event, yaml.AliasEvent):
            total += sizes.get(event.anchor, 1)
            if any(anchor == event.anchor for anchor, _ in stack):
                problem = f"the alias '*{event.anchor}' is within itself"
            if not aliases:
                problem = "aliases are not supported"
        if total > MAX_NODES:
            problem = f"expands to more than {MAX_NODES} values"
        if problem is not None:
            mark = event.start_mark
            raise DocumentError(problem, source, mark.line + 1, mark.column + 1)
