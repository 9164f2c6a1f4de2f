"""Reader of YAML files that may come from anywhere: one line for whatever is wrong, and limits on their size."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import Location, UserError

if TYPE_CHECKING:
    from collections.abc import Iterable

MAX_BYTES = 64 << 20
MAX_DEPTH = 100
"""Lists and mappings within each other; Python's recursion limit allows some hundreds."""
MAX_NODES = 1_000_000
"""Values of a document, counted as often as they occur once aliases are replaced by what they stand for."""


class DocumentError(UserError, ValueError):
    """A document that cannot be read."""


def read_text(path: Path | str) -> str:
    """Return the text of a file in UTF-8.

    Raises
    ------
    DocumentError
        When it is larger than `MAX_BYTES`, or not UTF-8.
    OSError
        When it cannot be opened.
    """
    with open(path, "rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise DocumentError(f"is larger than {MAX_BYTES >> 20} MiB", Location(str(path)))
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise DocumentError("is not valid UTF-8", Location(str(path), line)) from None


def read_yaml(path: Path | str) -> Any:
    """Return the content of a YAML file; see `parse_yaml` and `read_text`."""
    return parse_yaml(read_text(path), str(path))


def parse_yaml(text: str, source: str | None = None, loader: Any = None) -> Any:
    """Return the content of a YAML document.

    Parameters
    ----------
    text : str
    source : str, optional
        The file's name for errors.
    loader : yaml loader class, optional
        PyYAML's safe loader where None.

    Raises
    ------
    DocumentError
        When it is not valid, is nested too deeply, or expands to too much.
    """
    import yaml

    fast = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        _check_events(yaml.parse(text, fast), yaml, source)
        return yaml.load(text, loader or fast)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, max(error.position, 0)) + 1
        raise DocumentError(
            f"the character #x{ord_of(error.character):04x} is not allowed", Location(source, line)
        ) from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = " ".join(str(part) for part in (error.context, error.problem) if part) or "is not valid YAML"
        raise DocumentError(" ".join(problem.split()), Location(source, mark.line + 1 if mark else None)) from None
    except DocumentError:
        raise
    except RecursionError:
        raise _too_deep(source, None) from None
    except (
        yaml.YAMLError,
        ValueError,
        TypeError,
        OverflowError,
    ) as error:  # such as a month 13, or a key that is a list
        raise DocumentError(" ".join(str(error).split()) or "is not valid YAML", Location(source)) from None


def ord_of(character: Any) -> int:
    """Return the number of a character, which PyYAML gives as such or as a number."""
    return character if isinstance(character, int) else ord(character)


def _too_deep(source: str | None, line: int | None) -> DocumentError:
    return DocumentError(f"more than {MAX_DEPTH} levels within each other", Location(source, line))


def _check_events(events: Iterable[Any], yaml: Any, source: str | None) -> None:
    """Check the depth of a document, and how many values it has once aliases are replaced."""
    sizes: dict[str, int] = {}
    stack: list[tuple[str | None, int]] = []
    total = 0
    for event in events:
        if isinstance(event, yaml.MappingStartEvent | yaml.SequenceStartEvent):
            stack.append((event.anchor, total))
            total += 1
            if len(stack) > MAX_DEPTH:
                raise _too_deep(source, event.start_mark.line + 1)
        elif isinstance(event, yaml.MappingEndEvent | yaml.SequenceEndEvent):
            anchor, before = stack.pop()
            if anchor is not None:
                sizes[anchor] = total - before
        elif isinstance(event, yaml.ScalarEvent):
            total += 1
            if event.anchor is not None:
                sizes[event.anchor] = 1
        elif isinstance(event, yaml.AliasEvent):
            if event.anchor in {anchor for anchor, _ in stack}:
                raise DocumentError(f"the alias '*{event.anchor}' is within itself", _location(source, event))
            total += sizes.get(event.anchor, 1)
        if total > MAX_NODES:
            raise DocumentError(f"expands to more than {MAX_NODES} values", _location(source, event))


def _location(source: str | None, event: Any) -> Location:
    return Location(source, event.start_mark.line + 1)
