"""XML files as trees of elements that know the line they stand on."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, cast
from xml.parsers import expat

from launch.launch_file_error import LaunchFileError

from daidalos.common.documents import MAX_DEPTH, TOO_DEEP

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator


class LocatedElement(ET.Element):
    """An XML element with its file and line in `location`, like all elements inside it."""

    location: tuple[str | None, int | None] = (None, None)

    if TYPE_CHECKING:

        def __iter__(self) -> Iterator[LocatedElement]: ...

        def iter(self, tag: str | None = None) -> Generator[LocatedElement, None, None]: ...


def read_xml(text: str, filename: str | None) -> LocatedElement:
    """Return the root element of an XML document.

    Parameters
    ----------
    text
        The document.
    filename
        The file that it comes from, for messages.

    Raises
    ------
    LaunchFileError
        If it is not well formed.
    """
    builder = ET.TreeBuilder(element_factory=LocatedElement)
    parser = expat.ParserCreate()
    parser.buffer_text = True

    depth = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > MAX_DEPTH:
            raise LaunchFileError(filename, parser.CurrentLineNumber, f"malformed XML: {TOO_DEEP}")
        element = cast("LocatedElement", builder.start(tag, attributes))
        element.location = (filename, parser.CurrentLineNumber)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(text, True)
    except LookupError as error:  # an encoding that Python does not know
        raise LaunchFileError(filename, 1, f"malformed XML: {error}") from None
    except expat.ExpatError as error:
        reason = f"malformed XML: {expat.ErrorString(error.code)} at column {error.offset + 1}"
        raise LaunchFileError(filename, error.lineno, reason) from error
    return cast("LocatedElement", builder.close())
