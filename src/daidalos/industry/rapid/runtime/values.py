"""Values of RAPID data in Python.

num and dnum are float, in double precision both; string is str, bool is bool; records and arrays are lists, nested as
the data is. Data without values, such as clocks, are objects of their own.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from typing import Any

from daidalos.industry.rapid.declarations import MAX_ELEMENTS
from daidalos.industry.rapid.literals import parse_literals
from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.symbols import Type
from daidalos.industry.rapid.types import TypeTable

Reference = tuple[Any, Any]
"""Container and key of a value that a routine may change."""

MAX_STRING = 80


class Handle:
    """Data without a value: what a device, an interrupt or a connection keeps between calls."""

    def __init__(self, type_: str) -> None:
        self.type = type_
        self.state: Any = None


def default_value(types: TypeTable, type_: Type, sizes: list[int]) -> Any:
    """Return the value of data that was declared without one.

    Raises
    ------
    RapidError
        ERR_ILLDIM, where an array would be empty or too large.
    """
    if sizes and (min(sizes) < 1 or math.prod(sizes) > MAX_ELEMENTS):
        raise RapidError("ERR_ILLDIM", f"an array of {' x '.join(map(str, sizes))} elements")
    if sizes:
        return [default_value(types, Type(type_.name), sizes[1:]) for _ in range(sizes[0])]
    base = types.base(Type(type_.name))
    if base.name in ("num", "dnum"):
        return 0.0
    if base.name == "string":
        return ""
    if base.name == "bool":
        return False
    components = types.components(base)
    if components is not None:
        return [default_value(types, Type(one), []) for _, one in components]
    return Handle(base.name)


def is_scalar(types: TypeTable, type_: Type) -> bool:
    """Return whether values of a type are immutable in Python."""
    return not type_.dimensions and types.base(type_).name in (
        "num",
        "dnum",
        "string",
        "bool",
        "switch",
        "literal",
        "number",
    )


def copied(value: Any) -> Any:
    """Return a value that shares nothing with another one."""
    if isinstance(value, list):
        return [copied(one) if isinstance(one, list) else one for one in value]
    return value


def text_of(value: Any, digits: int = 6) -> str:
    """Return a value as it is written in a program, numbers with that many digits."""
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, float | int):
        return number_text(float(value), digits)
    if isinstance(value, str):
        doubled = value.replace("\\", "\\\\").replace('"', '""')
        return f'"{doubled}"'
    if isinstance(value, list):
        return f"[{','.join(text_of(one, digits) for one in value)}]"
    return f"<{value.type}>" if isinstance(value, Handle) else str(value)


def number_text(value: float, digits: int = 6) -> str:
    """Return a number in the shortest form with that many digits."""
    text = f"{value:.{digits}g}".replace("e", "E")
    if "E" in text:
        mantissa, exponent = text.split("E")
        text = f"{mantissa}E{int(exponent):+03d}"
    return "0" if text == "-0" else text


def value_of_text(text: str, like: Any) -> Any:
    """Return the value that a text is of, in the form of another value.

    Raises
    ------
    ValueError
        If the text is no such value.
    """
    value = parse_literals(f"[{text}]")
    if len(value) != 1 or not _is_like(value[0], like):
        raise ValueError(text)
    return copy.deepcopy(value[0])


def _is_like(value: Any, like: Any) -> bool:
    if isinstance(like, list):
        return isinstance(value, list) and len(value) == len(like) and all(map(_is_like, value, like))
    return type(value) is type(like)


def checked_string(value: str) -> str:
    """Return a string that is not too long for a controller.

    Raises
    ------
    RapidError
        ERR_STRTOOLNG
    """
    if len(value) > MAX_STRING:
        raise RapidError("ERR_STRTOOLNG", f"a string of {len(value)} characters; the most are {MAX_STRING}")
    return value


def index_of(value: float) -> int:
    """Return the index in Python of an index in RAPID, which counts from 1.

    Raises
    ------
    RapidError
        ERR_OUTOFBND, where it is below 1 or no whole number.
    """
    index = int(value)
    if index < 1 or index != value:
        raise RapidError("ERR_OUTOFBND", f"{number_text(value)} is no index of an array")
    return index - 1


def counted(first: float, last: float, step: float | None) -> Any:
    """Yield the values of a loop's counter; without a step it counts up or down by 1."""
    if step is None:
        step = 1.0 if last >= first else -1.0
    if step == 0.0:
        raise RapidError("ERR_ARGVALERR", "the step of FOR is 0")
    value = first
    while (value <= last) if step > 0 else (value >= last):
        yield value
        value += step


Function = Callable[..., Any]
