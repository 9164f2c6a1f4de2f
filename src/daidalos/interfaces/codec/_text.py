"""Text building blocks of codec functions: names, indentation and runs of fixed-size values.

In the generated code ``m`` is the message, ``out`` the list of buffers being collected, ``p`` the current
offset when it is known only at run time, ``buf`` the bytes being read and ``view`` their memoryview.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

from daidalos.interfaces.message import Message

FORMATS = {
    "bool": "?", "byte": "c", "char": "B", "uint8": "B", "int8": "b", "int16": "h", "uint16": "H",
    "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d",
}  # fmt: skip
SIZES = {name: struct.calcsize("<" + code) for name, code in FORMATS.items()}
_INLINE_LIMIT = 48
"""Maximum number of values of a message whose code is inlined in its parent's."""
HEADER = 4


@dataclass(frozen=True)
class Variant:
    """Byte order ('<' or '>') and number of bytes per character of wide strings."""

    order: str = "<"
    wide: int = 4


def fixed_size(kind: type[Message]) -> tuple[int, int] | None:
    """Return (size, alignment) of a message with the same layout at every offset, None for others.

    CDR aligns values, not messages. The layout is the same everywhere only if the first value is among those
    of the greatest alignment and the size is a multiple of it, so that neighbours in an array repeat.
    """
    offset, alignment, first = 0, 1, 0
    for _, base, many, size, _ in kind._FIELDS:
        if many not in ("single", "array") or base in ("string", "wstring"):
            return None
        inner = (SIZES[base], SIZES[base]) if isinstance(base, str) else fixed_size(base)
        if inner is None:
            return None
        offset += -offset % inner[1] + inner[0] * (size if many == "array" else 1)
        alignment = max(alignment, inner[1])
        first = first or inner[1]
    if not kind._FIELDS or first != alignment or offset % alignment:
        return None
    return offset, alignment


def _weight(kind: type[Message]) -> int:
    """Return the number of values that inlining the message would write out."""
    return sum(1 if isinstance(base, str) else _weight(base) for _, base, *_ in kind._FIELDS)


class Names:
    """Objects that generated code refers to, each under one name."""

    def __init__(self, root: type[Message]) -> None:
        self.scope: dict[str, Any] = {"Root": root}
        self._known: dict[Any, str] = {}

    def of(self, key: Any, value: Any, prefix: str) -> str:
        name = self._known.get(key)
        if name is None:
            name = f"{prefix}{len(self._known)}"
            self._known[key] = name
            self.scope[name] = value
        return name

    def kind(self, message_type: type[Message]) -> str:
        return self.of(message_type, message_type, "C")


@dataclass
class Run:
    """Consecutive values of fixed size that one struct call reads or writes."""

    items: list[tuple[str, int, int]] = field(default_factory=list)
    """(format, alignment, size) of each value."""
    expressions: list[str] = field(default_factory=list)

    def layout(self, order: str, start: int) -> tuple[str, int]:
        """Return the struct format and the size of the run when it starts at offset `start`."""
        text, offset = order, start
        for code, alignment, size in self.items:
            pad = -offset % alignment
            text += ("x" * pad) + code
            offset += pad + size
        return text, offset - start

    def structs(self, order: str, shift: int = 0) -> tuple[struct.Struct, ...]:
        """Return the eight structs for offsets 0 to 7, counted from `shift`."""
        return tuple(struct.Struct(self.layout(order, start - shift)[0]) for start in range(8))


class Generator:
    """Generated text with indentation, unused names and the offset as far as it is known."""

    def __init__(self, root: type[Message], variant: Variant) -> None:
        self.root = root
        self.variant = variant
        self.names = Names(root)
        self.lines: list[str] = []
        self.indent = 1
        self.counter = 0
        self.functions: dict[type[Message], str] = {}
        self.pending: list[type[Message]] = []
        self.run = Run()
        self.static: int | None = 0

    def emit(self, text: str) -> None:
        self.lines.append("    " * self.indent + text)

    def fresh(self, prefix: str) -> str:
        self.counter += 1
        return f"{prefix}{self.counter}"

    def function(self, kind: type[Message]) -> str:
        """Return the name of the function for a nested message that is not inlined."""
        if kind not in self.functions:
            self.functions[kind] = f"nested{len(self.functions)}"
            self.pending.append(kind)
        return self.functions[kind]

    def inlined(self, kind: type[Message]) -> bool:
        return _weight(kind) <= _INLINE_LIMIT

    def finish(self, head: list[str]) -> tuple[str, dict[str, Any]]:
        return "\n".join([*head, *self.lines]) + "\n", self.names.scope
