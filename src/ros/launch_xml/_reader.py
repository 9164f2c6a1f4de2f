"""XML files as trees of elements that know the line they stand on."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from xml.parsers import expat

from launch.launch_file_error import LaunchFileError


class LocatedElement(ET.Element):
    """An XML element with its file and line in `location`."""

    location: tuple[str | None, int | None] = (None, None)


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

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = builder.start(tag, attributes)
        element.location = (filename, parser.CurrentLineNumber)

    parser.StartElementHandler = start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        reason = f"malformed XML: {expat.ErrorString(error.code)} at column {error.offset + 1}"
        raise LaunchFileError(filename, error.lineno, reason) from error
    return builder.close()
