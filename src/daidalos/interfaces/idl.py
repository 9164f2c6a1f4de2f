"""Reader of .idl files that rosidl generates for messages, services and actions.

The subset of OMG IDL 4.2 is that of https://design.ros2.org/articles/idl_interface_definition.html: modules, structs,
constants, typedefs of arrays and sequences, and the annotations for comments and default values.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import NamedTuple

from daidalos.common.errors import Location
from daidalos.interfaces.parser import InterfaceError

_TOKEN = re.compile(
    r'(?P<space>\s+|//[^\n]*|/\*.*?\*/|#[^\n]*)|(?P<text>"(?:\\.|[^"\\])*")|'
    r"(?P<word>[A-Za-z_]\w*(?:::\w+)*)|(?P<number>[-+]?[\d.][\w.]*(?:[eE][-+]?\d+)?)|(?P<sign>[{}\[\]()<>;,=@])",
    re.DOTALL,
)
_PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
_TYPES = {
    "boolean": "bool",
    "octet": "byte",
    "char": "uint8",
    "float": "float32",
    "double": "float64",
    "short": "int16",
    "long": "int32",
    "long long": "int64",
    "unsigned short": "uint16",
    "unsigned long": "uint32",
    "unsigned long long": "uint64",
    **{name: name for name in ("string", "wstring", *(f"{u}int{bits}" for u in ("", "u") for bits in (8, 16, 32, 64)))},
}
_PLACEHOLDER = "structure_needs_at_least_one_member"
"""Placeholder member of a struct for a message without fields."""


class IdlInterface(NamedTuple):
    """Interface of an .idl file.

    Attributes
    ----------
    package, kind, name
        Such as ``std_msgs``, ``msg`` and ``String``.
    text
        What it says as a .msg, .srv or .action file.
    """

    package: str
    kind: str
    name: str
    text: str


def read_idl(text: str, name: str, source: str = "<text>") -> IdlInterface:
    """Read the text of an .idl file.

    Parameters
    ----------
    text
        The text.
    name
        Name of the interface, which is that of the file without its ending.
    source
        What errors call the file.

    Raises
    ------
    InterfaceError
        Naming `source` and the line that is no part of the subset.
    """
    reader = _Reader(_tokens(text, source), source)
    reader.read_modules(())
    for path, structs in reader.structs.items():
        if len(path) != 2:
            continue
        package, kind = path
        parts = [f"{name}{part}" for part in _PARTS.get(kind, ())]
        if parts and all(part in structs for part in parts):
            blocks = []
            for part in parts:
                comment, members = structs[part]
                constants = reader.constants.get((package, kind, f"{part}_Constants"), [])
                blocks.append([*comment, *[""][: len(comment)], *constants, *members])
            lines = [line for block in blocks for line in ["---", *block]][1:]
            return IdlInterface(package, kind, name, "\n".join(lines) + "\n")
    raise InterfaceError(
        f"there is no struct '{name}' in a module 'msg', nor the parts of a service or action", Location(source)
    )


class _Token(NamedTuple):
    kind: str
    text: str
    line: int


def _tokens(text: str, source: str) -> list[_Token]:
    found = []
    place, line = 0, 1
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            raise InterfaceError(f"unexpected {text[place]!r}", Location(source, line))
        if match.lastgroup != "space":
            found.append(_Token(match.lastgroup or "", match[0], line))
        line += match[0].count("\n")
        place = match.end()
    return [*found, _Token("end", "the end of the file", line)]


@dataclass
class _Notes:
    """Annotations of the declaration that follows."""

    comment: list[str] = field(default_factory=list)
    default: str = ""


class _Reader:
    """Token reader; `structs` holds comments and members by name by module, `constants` lines by module."""

    def __init__(self, tokens: list[_Token], source: str) -> None:
        self._tokens = tokens
        self._place = 0
        self._source = source
        self._typedefs: dict[str, str] = {}
        self.structs: dict[tuple[str, ...], dict[str, tuple[list[str], list[str]]]] = {}
        self.constants: dict[tuple[str, ...], list[str]] = {}

    def _take(self, *expected: str) -> str:
        """Return the text of the next token, which must be one of the given ones, if any."""
        token = self._tokens[self._place]
        if expected and token.text not in expected and token.kind not in expected:
            wanted = " or ".join(f"'{one}'" for one in expected)
            raise InterfaceError(f"expected {wanted}, found '{token.text}'", Location(self._source, token.line))
        self._place += 1
        return token.text

    def _next_is(self, text: str) -> bool:
        return self._tokens[self._place].text == text

    def read_modules(self, path: tuple[str, ...]) -> None:
        while not self._next_is("}") and self._tokens[self._place].kind != "end":
            notes = self._annotations()
            what = self._take("module", "struct", "typedef", "const")
            if what == "module":
                name = self._take("word")
                self._take("{")
                self.read_modules((*path, name))
                self._take("}")
            elif what == "struct":
                name = self._take("word")
                self.structs.setdefault(path, {})[name] = (_comment(notes), self._members())
            elif what == "typedef":
                kind = self._type()
                name = self._take("word")
                self._typedefs[name] = kind + self._dimension()
            else:
                line = f"{self._type()} {self._take('word')}{self._take('=')}{self._constant()}"
                self.constants.setdefault(path, []).extend([*_comment(notes), line])
            self._take(";")
        if not path:
            self._take("end")

    def _members(self) -> list[str]:
        self._take("{")
        lines = []
        while not self._next_is("}"):
            notes = self._annotations()
            kind = self._type()
            name = self._take("word")
            kind += self._dimension()
            self._take(";")
            if name != _PLACEHOLDER:
                lines += [*_comment(notes), f"{kind} {name} {notes.default}".rstrip()]
        self._take("}")
        return lines

    def _annotations(self) -> _Notes:
        notes = _Notes()
        while self._next_is("@"):
            self._take("@")
            name = self._take("word")
            values = self._annotation_values() if self._next_is("(") else {}
            if name == "verbatim" and values.get("language") == '"comment"':
                notes.comment = _unquoted(values.get("text", '""')).splitlines()
            elif name == "default":
                notes.default = _value(values.get("value", ""))
        return notes

    def _annotation_values(self) -> dict[str, str]:
        values: dict[str, str] = {}
        self._take("(")
        while not self._next_is(")"):
            name = self._take("word", "number", "text")
            if self._next_is("="):
                self._take("=")
                values[name] = self._constant()
            if self._next_is(","):
                self._take(",")
        self._take(")")
        return values

    def _constant(self) -> str:
        """Return a constant's value; adjacent texts are concatenated."""
        value = self._take("text", "number", "word")
        while value.startswith('"') and self._tokens[self._place].kind == "text":
            value = value[:-1] + self._take("text")[1:]
        return value if value.startswith('"') else _value(value)

    def _type(self) -> str:
        word = self._take("word")
        if word == "sequence":
            self._take("<")
            kind = self._type()
            bound = ""
            if self._next_is(","):
                self._take(",")
                bound = f"<={self._take('number')}"
            self._take(">")
            return f"{kind}[{bound}]"
        while f"{word} {self._tokens[self._place].text}" in (
            "unsigned short",
            "unsigned long",
            "long long",
            "unsigned long long",
        ):
            word = f"{word} {self._take('word')}"
        if word in ("string", "wstring") and self._next_is("<"):
            self._take("<")
            bound = self._take("number")
            self._take(">")
            return f"{word}<={bound}"
        if "::" in word:
            package, _, rest = word.partition("::")
            return f"{package}/{rest.rpartition('::')[2]}" if rest.startswith("msg::") else self._unknown(word)
        return self._typedefs.get(word) or _TYPES.get(word) or self._unknown(word)

    def _unknown(self, word: str) -> str:
        line = self._tokens[self._place - 1].line
        raise InterfaceError(f"the type '{word}' is not known", Location(self._source, line))

    def _dimension(self) -> str:
        if not self._next_is("["):
            return ""
        self._take("[")
        size = self._take("number")
        self._take("]")
        return f"[{size}]"


def _comment(notes: _Notes) -> list[str]:
    return [f"# {line}".rstrip() for line in notes.comment]


def _value(text: str) -> str:
    """Return an IDL value as .msg text; lists in texts are in round brackets."""
    if text in ("TRUE", "FALSE"):
        return text.lower()
    inner = _unquoted(text)
    if text.startswith('"') and inner.startswith("(") and inner.endswith(")"):
        return f"[{inner[1:-1].rstrip(', ')}]"
    return text


def _unquoted(text: str) -> str:
    if not text.startswith('"'):
        return text
    try:
        return str(json.loads(text, strict=False))
    except ValueError:  # an escape of C that JSON does not have
        return text[1:-1]
