"""Reader of package.xml, formats 1 to 3."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from daidalos.common.errors import Location
from daidalos.distribution import ENVIRONMENT
from daidalos.workspaces.errors import WorkspaceError


def read(path: Path) -> Any:
    """Return a manifest as `catkin_pkg.package.Package`, conditions evaluated; None for other files.

    Raises
    ------
    WorkspaceError
        Naming the file and the line at fault.
    """
    from catkin_pkg.package import InvalidPackage, parse_package_string

    text = _text(path)
    if _root(path, text) != "package":
        return None
    try:
        package = parse_package_string(text, str(path))
        package.evaluate_conditions({**ENVIRONMENT, **os.environ})
        package.get_build_type()
    except (InvalidPackage, AssertionError, ValueError) as error:
        raise WorkspaceError(_located(path, text, str(error))) from None
    return package


def _text(path: Path) -> str:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise WorkspaceError(f"byte {error.start} is not valid UTF-8", Location(str(path))) from None
    if not text.strip():
        raise WorkspaceError(f"{path}:1: the file is empty")
    return text


def _root(path: Path, text: str) -> str:
    try:
        return ElementTree.fromstring(text.encode()).tag
    except LookupError as error:  # an encoding that Python does not know
        raise WorkspaceError(f"not valid XML: {error}", Location(str(path), 1)) from None
    except ElementTree.ParseError as error:
        line, column = error.position
        what = str(error).partition(":")[0]
        raise WorkspaceError(f"not valid XML: {what} (column {column + 1})", Location(str(path), line)) from None


def _located(path: Path, text: str, message: str) -> str:
    """Return one line about an error, with the line of the element or value that it names."""
    lines = [line.strip(" -") for line in message.splitlines()]
    faults = [line for line in lines if line and not line.startswith("Error(s)")]
    fault = "; ".join(faults).rstrip(".") or message.replace("\n", " ")
    return f"{path}:{_line(text, fault)}: {fault}"


def _line(text: str, fault: str) -> int:
    """Return the line of the first quoted text in the message, or of the tag that it names; else the first."""
    lines = text.splitlines()
    named = re.findall(r"[\"'<]([^\"'<>]+)[\"'>]", fault) + re.findall(r"tags: (\w+)", fault)
    quoted = [re.escape(word) for word in named]
    for pattern in [*(rf"<{word}\b" for word in quoted), *(rf"(?<!\w){word}(?!\w)" for word in quoted)]:
        for number, line in enumerate(lines, 1):
            if re.search(pattern, line):
                return number
    return next((number for number, line in enumerate(lines, 1) if "<package" in line), 1)
