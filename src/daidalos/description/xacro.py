"""Expansion of xacro files by the `xacro` package, with file and line of each element.

xacro offers no way to ask where an element came from and finds packages only through an installed
ROS index. Both are supplied here while it runs: its parser marks every ordinary element with its
origin, and its ``$(find)`` asks the caller's resolver first.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any
from xml.dom import expatbuilder, minidom
from xml.parsers import expat

from daidalos.common.documents import MAX_DEPTH, TOO_DEEP
from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element
from daidalos.description.xacro_limits import ReadableFiles, limited

if TYPE_CHECKING:
    from daidalos.description.resolve import PackageResolver

_ORIGIN = "daidalos-origin"
_LOCK = threading.Lock()  # xacro keeps its state in module variables


def load_xacro(
    path: Path | str,
    mappings: Mapping[str, str] | None = None,
    resolve: PackageResolver | None = None,
) -> str:
    """Expand a xacro file to XML text.

    Parameters
    ----------
    path : Path or str
    mappings : mapping or None
        Values for its ``<xacro:arg>``.
    resolve : callable or None
        Share directory of a package, for ``$(find package)``.

    Returns
    -------
    str
        The description without macros.

    Raises
    ------
    DescriptionError
        When the file or one that it includes is missing, malformed or uses what is not defined.
    """
    return '<?xml version="1.0"?>\n' + expand(path, mappings, resolve).to_text()


def expand(
    path: Path | str,
    mappings: Mapping[str, str] | None = None,
    resolve: PackageResolver | None = None,
) -> Element:
    """Expand a xacro file to elements with the file and line where they were written.

    Parameters, errors: as `load_xacro`.
    """
    path = Path(path)
    if not path.is_file():
        raise DescriptionError("no such file", str(path))
    import xacro

    with _LOCK, _supplied(xacro, resolve, path.parent) as files, limited(xacro, ReadableFiles(mappings)):
        xacro.init_stacks(str(path))
        try:
            document = xacro.parse(None, str(path))
            _define_m_pi(document)
            xacro.process_doc(document, mappings=dict(mappings or {}), verbosity=0)
        except expat.ExpatError as problem:
            reason = expat.ErrorString(problem.code)
            source = str(xacro.filestack[-1])
            raise DescriptionError(f"not well-formed XML: {reason}", source, problem.lineno) from None
        except Exception as problem:
            # xacro evaluates what the user wrote, so that anything can be raised from there.
            raise _error(problem, xacro, files) from None
        finally:
            xacro.substitution_args_context["arg"] = {}
        return _element(document.documentElement, files, str(path), 1)


@contextmanager
def _supplied(xacro: Any, resolve: PackageResolver | None, folder: Path) -> Iterator[list[str]]:
    """Replace xacro's parser and package lookup by ours; yield the list of files that were read."""
    from xacro import substitution_args

    from daidalos.description.resolve import packages_near

    files: list[str] = []
    parse, find = xacro.parse, substitution_args._eval_find

    def parse_marked(text: Any, filename: str | None = None) -> Any:
        if text is not None:
            return parse(text, filename)
        path = Path(xacro.root_dir) / str(filename)
        try:
            body = path.read_bytes()
        except OSError as problem:
            xacro.filestack.pop()
            raise xacro.XacroException(f"{problem.strerror}: {path}", exc=problem) from None
        files.append(str(path))
        return _parse_marked(body, len(files) - 1)

    def find_package(name: str) -> str:
        share = None if resolve is None else resolve(name)
        if share is not None:
            return str(share)
        try:
            return str(find(name))
        except (ImportError, LookupError):
            for near in packages_near(name, folder):
                return str(near)
            raise DescriptionError(f"package {name!r} not found") from None

    xacro.parse, substitution_args._eval_find = parse_marked, find_package
    try:
        yield files
    finally:
        xacro.parse, substitution_args._eval_find = parse, find


def _parse_marked(body: bytes, file_index: int) -> minidom.Document:
    """Parse a document, each element with its location.

    xacro takes an attribute on one of its own tags for a macro's parameter, and copies of elements
    lose what is not an attribute: hence both ways of keeping it.
    """
    builder: Any = expatbuilder.ExpatBuilderNS()
    start_element, end_element = builder.start_element_handler, builder.end_element_handler

    depth = 0

    def start_marked(name: str, attributes: list[str]) -> None:
        nonlocal depth
        depth += 1
        if depth > MAX_DEPTH:
            raise DescriptionError(TOO_DEEP)
        start_element(name, attributes)
        node = builder.curNode
        node.daidalos_origin = f"{file_index}:{builder.getParser().CurrentLineNumber}"
        if not node.tagName.startswith("xacro:"):
            node.setAttribute(_ORIGIN, node.daidalos_origin)

    def end_marked(name: str) -> None:
        nonlocal depth
        depth -= 1
        end_element(name)

    builder.start_element_handler = start_marked
    builder.end_element_handler = end_marked
    document: minidom.Document = builder.parseString(body)
    return document


def _define_m_pi(document: minidom.Document) -> None:
    """Define ``M_PI``, which descriptions from ROS 1 use, unless a file defines it."""
    root = document.documentElement
    assert root is not None
    definition = document.createElement("xacro:property")
    definition.setAttribute("name", "M_PI")
    definition.setAttribute("value", repr(math.pi))
    root.insertBefore(definition, root.firstChild)


def _error(problem: BaseException, xacro: Any, files: list[str]) -> DescriptionError:
    """Return the error's message with its location and its macro."""
    words = " ".join(str(problem).split()) or type(problem).__name__
    cause: BaseException | None = problem
    while cause is not None:
        if isinstance(cause, DescriptionError):
            words = cause.message
        elif isinstance(cause, OSError):
            words = f"{cause.strerror}: {cause.filename}"
        cause = getattr(cause, "exc", None)
    words = words[:1].lower() + words[1:] if words[:2].istitle() else words
    source, line = _innermost_origin(problem.__traceback__, files)
    stack = xacro.macrostack or []
    if isinstance(problem, RecursionError):
        words = "the macro calls itself without end" if stack else "the file includes itself"
    macro = f"<xacro:{stack[-1].body.getAttribute('name')}>" if stack else ""
    return DescriptionError(words, source or str(xacro.filestack[-1]), line, macro)


def _innermost_origin(trace: TracebackType | None, files: list[str]) -> tuple[str, int]:
    """Return file and line of the last element that xacro processed."""
    source, line = "", 0
    while trace is not None:
        for name in ("elt", "node"):
            node = trace.tb_frame.f_locals.get(name)
            origin = getattr(node, "daidalos_origin", "")
            if not origin and isinstance(node, minidom.Element):
                origin = node.getAttribute(_ORIGIN)
            if origin:
                index, _, number = origin.partition(":")
                source, line = files[int(index)], int(number)
                break
        trace = trace.tb_next
    return source, line


def _element(node: minidom.Element, files: list[str], source: str, line: int) -> Element:
    """Convert xacro's result to our elements; elements created by xacro get their parent's location."""
    attributes = dict(node.attributes.items())
    origin = attributes.pop(_ORIGIN, "")
    if origin:
        index, _, number = origin.partition(":")
        source, line = files[int(index)], int(number)
    element = Element(node.tagName, attributes, source=source, line=line)
    for child in node.childNodes:
        if child.nodeType == child.ELEMENT_NODE:
            element.children.append(_element(child, files, source, line))
        elif child.nodeType in (child.TEXT_NODE, child.CDATA_SECTION_NODE):
            element.text += child.data
    return element
