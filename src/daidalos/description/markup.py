"""XML elements with file and line, and typed access to their values."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from xml.parsers import expat
from xml.sax.saxutils import escape, quoteattr

from daidalos.common.documents import MAX_DEPTH, TOO_DEEP
from daidalos.common.errors import Location
from daidalos.description.errors import DescriptionError
from daidalos.description.markup_repair import repair

_TRUE = frozenset({"true", "1", "yes", "on"})
_FALSE = frozenset({"false", "0", "no", "off"})

_HEXADECIMAL = re.compile(r"[+-]?0[xX][0-9a-fA-F]+")
_MAX_EXPANSION = 100_000
"""Characters by which entities may make the text of a document longer than the document."""
_DECLARATION = re.compile(rb"((?:<!--.*?-->\s*)*)(<\?xml\b(\s+version\b)?[^>\n]*\?>)", re.DOTALL)


def parse_markup(text: str | bytes, source: str = "") -> Element:
    """Read an XML document.

    Parameters
    ----------
    text : str or bytes
        The document. White space and comments before the XML declaration, one without a version, zeros at
        the end and what `repair` lists are tolerated, as by ROS's own parsers.
    source : str
        Where it came from; errors name it.

    Returns
    -------
    Element
        The root element.

    Raises
    ------
    DescriptionError
        When the document is not well formed, with its line.
    """
    encoding = "utf-8" if isinstance(text, str) else None
    if isinstance(text, str):
        text = text.encode()
    text = text.removeprefix(b"\xef\xbb\xbf")
    end = len(text.rstrip(b"\0 \t\r\n"))
    if b"\0" not in text[:4] and b"\0" in text[end:]:  # zeros at the beginning would be UTF-16
        text = text[:end]
    body = text.lstrip()
    if not body:
        raise DescriptionError("the document is empty, expected XML", source)
    skipped_lines = text[: len(text) - len(body)].count(b"\n")
    body = _without_odd_declaration(body)
    try:
        return _TreeBuilder(source, skipped_lines, encoding).build(body)
    except DescriptionError as error:
        # The error of the text as written is the one to report.
        try:
            return _TreeBuilder(source, skipped_lines, encoding).build(repair(body))
        except DescriptionError:
            raise error from None


def _without_odd_declaration(body: bytes) -> bytes:
    """Blank an XML declaration that comes after comments or lacks the version."""
    found = _DECLARATION.match(body)
    if found is None or (not found[1] and found[3]):
        return body
    return found[1] + b" " * len(found[2]) + body[found.end() :]


class Element:
    """XML element: tag, attributes, text, children and location.

    Prefixes are kept as written (``sensor:camera``), since descriptions in the wild use undeclared ones.
    """

    __slots__ = ("attributes", "children", "line", "source", "tag", "text")

    def __init__(
        self,
        tag: str,
        attributes: dict[str, str] | None = None,
        text: str = "",
        children: list[Element] | None = None,
        source: str = "",
        line: int = 0,
    ) -> None:
        self.tag = tag
        self.attributes = {} if attributes is None else attributes
        self.text = text
        self.children = [] if children is None else children
        self.source = source
        self.line = line

    def __repr__(self) -> str:
        return f"Element({self.label}, {self.source}:{self.line})"

    def __iter__(self) -> Iterator[Element]:
        return iter(self.children)

    @property
    def label(self) -> str:
        """Element in short notation: ``<joint name="elbow">``."""
        name = self.attributes.get("name", "").strip()
        return f'<{self.tag} name="{name}">' if name else f"<{self.tag}>"

    @property
    def where(self) -> str:
        """File and line as ``file:line``."""
        return str(self.location)

    @property
    def location(self) -> Location:
        """File and line for errors."""
        return Location(self.source or None, self.line or None)

    def error(self, message: str) -> DescriptionError:
        """Return an error that names this element and its location."""
        return DescriptionError(message, self.source, self.line, self.label)

    # Children

    def first(self, *tags: str) -> Element | None:
        """Return the first child with one of `tags`, tried in the order given."""
        for tag in tags:
            for child in self.children:
                if child.tag == tag:
                    return child
        return None

    def require(self, tag: str) -> Element:
        """Return the first child `tag` or raise a `DescriptionError`."""
        child = self.first(tag)
        if child is None:
            raise self.error(f"<{tag}> is missing")
        return child

    def all(self, *tags: str) -> list[Element]:
        """Return the children whose tag is one of `tags`, in document order."""
        return [child for child in self.children if child.tag in tags]

    def walk(self) -> Iterator[Element]:
        """Yield this element and everything below it, in document order."""
        yield self
        for child in self.children:
            yield from child.walk()

    # Attributes

    def name(self) -> str:
        """Return the ``name`` attribute, which is required."""
        name = self.attribute("name")
        if not name:
            raise self.error('attribute "name" is empty')
        return name

    def attribute(self, key: str, default: str | None = None) -> str:
        """Return an attribute without surrounding white space; it is required without `default`."""
        value = self.attributes.get(key, default)
        if value is None:
            raise self.error(f'attribute "{key}" is missing')
        return value.strip()

    def number_attribute(self, key: str, default: float | None = None, finite: bool = True) -> float:
        """Return an attribute as a number; it is required without `default`."""
        value = self.attributes.get(key)
        if value is None and default is not None:
            return default
        return self._number(self.attribute(key), f'attribute "{key}"', finite)

    def vector_attribute(self, key: str, size: int, default: tuple[float, ...] | None = None) -> tuple[float, ...]:
        """Return an attribute as `size` numbers; it is required without `default`."""
        value = self.attributes.get(key)
        if value is None and default is not None:
            return default
        return self._vector(self.attribute(key), size, f'attribute "{key}"')

    # Text of children: <radius>0.1</radius>. Several tags are alternative spellings, tried in order.

    def text_of(self, *tags: str, default: str = "") -> str:
        """Return a child's text without surrounding white space."""
        child = self.first(*tags)
        return default if child is None else child.text.strip()

    def number_of(self, *tags: str, default: float) -> float:
        """Return a child's text as a number (``inf`` is accepted)."""
        child = self.first(*tags)
        return default if child is None or not child.text.strip() else child.number()

    def integer_of(self, *tags: str, default: int) -> int:
        """Return a child's text as an integer; ``640.0`` is valid, ``0.5`` is not."""
        value = self.number_of(*tags, default=default)
        if not math.isfinite(value) or value != int(value):
            child = self.first(*tags) or self
            raise child.error(f"expected an integer, got {child.text.strip()!r}")
        return int(value)

    def flag_of(self, *tags: str, default: bool) -> bool:
        """Return a child's text as a truth value (``true``, ``1``, ``false``, ``0``)."""
        child = self.first(*tags)
        return default if child is None or not child.text.strip() else child.flag()

    def vector_of(self, *tags: str, size: int, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return a child's text as `size` numbers."""
        child = self.first(*tags)
        return default if child is None or not child.text.strip() else child.vector(size)

    # This element's own text

    def number(self) -> float:
        """Return this element's text as a number, decimal or hexadecimal (``0xFF``)."""
        text = self.text.strip()
        if _HEXADECIMAL.fullmatch(text):
            return float(int(text, 16))
        return self._number(text, "the text", finite=False)

    def vector(self, size: int) -> tuple[float, ...]:
        """Return this element's text as `size` numbers."""
        return self._vector(self.text, size, "the text")

    def flag(self) -> bool:
        """Return this element's text as a truth value."""
        word = self.text.strip().lower()
        if word in _TRUE:
            return True
        if word in _FALSE:
            return False
        raise self.error(f"expected true or false, got {self.text.strip()!r}")

    def to_text(self, indent: int = 0) -> str:
        """Return this element as XML text."""
        pad = "  " * indent
        attributes = "".join(f" {key}={quoteattr(value)}" for key, value in self.attributes.items())
        text = escape(self.text.strip())
        if not self.children:
            body = f">{text}</{self.tag}>" if text else "/>"
            return f"{pad}<{self.tag}{attributes}{body}\n"
        children = "".join(child.to_text(indent + 1) for child in self.children)
        words = f"{pad}  {text}\n" if text else ""
        return f"{pad}<{self.tag}{attributes}>\n{words}{children}{pad}</{self.tag}>\n"

    def _number(self, text: str, what: str, finite: bool = True) -> float:
        try:
            value = float(text if "_" not in text else "")  # Python's digit groups are no part of the format
        except ValueError:
            raise self.error(f"{what} should be a number, got {text.strip()!r}") from None
        if math.isnan(value) or (finite and math.isinf(value)):
            raise self.error(f"{what} should be a finite number, got {text.strip()!r}")
        return value

    def _vector(self, text: str, size: int, what: str) -> tuple[float, ...]:
        words = text.split()
        if len(words) != size:
            raise self.error(f"{what} should be {size} numbers, got {text.strip()!r}")
        return tuple(self._number(word, what) for word in words)


class _TreeBuilder:
    """Builder of elements from expat's events."""

    def __init__(self, source: str, skipped_lines: int, encoding: str | None) -> None:
        self._source = source
        self._skipped_lines = skipped_lines
        self._stack: list[Element] = []
        self._expanded = 0
        self._root: Element | None = None
        self._parser = expat.ParserCreate(encoding)  # which limits what entities expand to
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._characters

    def build(self, body: bytes) -> Element:
        self._expanded = len(body) + _MAX_EXPANSION
        try:
            self._parser.Parse(body, True)
        except LookupError as problem:  # an encoding that Python does not know
            raise DescriptionError(f"not well-formed XML: {problem}", self._source, 1) from None
        except expat.ExpatError as problem:
            reason = expat.ErrorString(problem.code)
            raise DescriptionError(
                f"not well-formed XML: {reason}", self._source, problem.lineno + self._skipped_lines
            ) from None
        assert self._root is not None
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber + self._skipped_lines
        element = Element(tag, attributes, source=self._source, line=line)
        if self._stack:
            self._stack[-1].children.append(element)
        else:
            self._root = element
        if len(self._stack) >= MAX_DEPTH:
            raise DescriptionError(TOO_DEEP, self._source, line)
        self._stack.append(element)

    def _end(self, tag: str) -> None:
        self._stack.pop()

    def _characters(self, data: str) -> None:
        self._expanded -= len(data)
        if self._expanded < 0:
            line = self._parser.CurrentLineNumber + self._skipped_lines
            raise DescriptionError("the entities expand to too much text", self._source, line)
        if self._stack:
            self._stack[-1].text += data
