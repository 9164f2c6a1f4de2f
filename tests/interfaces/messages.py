"""Message classes to try things on: all that are built in, and strategies that fill them."""

from __future__ import annotations

import importlib
import math
import struct
from array import array
from typing import Any

import numpy as np
from hypothesis import strategies as st

from daidalos.interfaces.definition import INTEGER_RANGES, Action, messages_of
from daidalos.interfaces.library import built_in
from daidalos.interfaces.message import TYPECODES, Message

MAX_ITEMS = 3
TEXT = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=8)
WIDE_TEXT = st.text(st.characters(max_codepoint=0xFFFF, exclude_characters="\0", exclude_categories=["Cs"]), max_size=8)


def class_of(name: str) -> Any:
    """Return the class of ``package/kind/Name``."""
    package, kind, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), short)


def all_names() -> list[str]:
    """Return the names of all built-in messages, the parts of services and actions among them."""
    library = built_in()
    names = []
    for package in library.packages():
        for name in library.names(package):
            interface = library.get(name)
            names += [message.name for message in messages_of(interface)]
            if isinstance(interface, Action):
                names += [part.name for s in (interface.send_goal, interface.get_result) for part in s.messages]
    return list(dict.fromkeys(names))


NAMES = all_names()
PACKAGES = built_in().packages()


@st.composite
def messages(draw: st.DrawFn, kind: type[Message]) -> Message:
    """Return a strategy for messages of a class with any values."""
    return kind(**{name: draw(values(*rest)) for name, *rest in kind._FIELDS})


def values(base: Any, many: str, size: int, bound: int | None) -> st.SearchStrategy[Any]:
    """Return a strategy for what a field may hold."""
    one = single(base, bound)
    if many == "single":
        return one
    if many == "array":
        return fixed(base, st.lists(one, min_size=size, max_size=size))
    return st.lists(one, max_size=min(size, MAX_ITEMS) if many == "bounded" else MAX_ITEMS)


def fixed(base: Any, items: st.SearchStrategy[list[Any]]) -> st.SearchStrategy[Any]:
    return items.map(lambda found: np.array(found, TYPECODES[base])) if base in TYPECODES else items


def single(base: Any, bound: int | None) -> st.SearchStrategy[Any]:
    if not isinstance(base, str):
        return messages(base)
    if base in INTEGER_RANGES and base != "byte":
        return st.integers(*INTEGER_RANGES[base])
    if base == "bool":
        return st.booleans()
    if base == "byte":
        return st.binary(min_size=1, max_size=1)
    if base in ("float32", "float64"):
        return st.floats(width=32 if base == "float32" else 64, allow_nan=False)
    text = TEXT if base == "string" else WIDE_TEXT
    return text if bound is None else text.map(lambda found: found[:bound])


def from_plain(kind: type[Message], fields: dict[str, Any]) -> Message:
    """Make a message from dictionaries, lists and numbers."""
    return kind(**{name: _value(fields[name], *rest) for name, *rest in kind._FIELDS})


def _value(value: Any, base: Any, many: str, *_: Any) -> Any:
    if not isinstance(base, str):
        return from_plain(base, value) if many == "single" else [from_plain(base, one) for one in value]
    if base == "byte":
        return bytes([value]) if many == "single" else [bytes([one]) for one in value]
    return value


def to_plain(value: Any) -> Any:
    """Return a message as dictionaries, lists and numbers; floats as their bits, so that NaN equals itself."""
    if hasattr(value, "_FIELDS"):
        return {name: to_plain(getattr(value, name)) for name, *_ in value._FIELDS}
    if isinstance(value, (list, tuple, array, np.ndarray)):
        return [to_plain(one) for one in value]
    if isinstance(value, (float, np.floating)):
        return "nan" if math.isnan(value) else struct.pack("<d", value)
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, bytes):
        return value[0]
    return value
