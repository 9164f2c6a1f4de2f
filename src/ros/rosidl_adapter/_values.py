"""Values of constants and defaults, as text."""

from __future__ import annotations

import re
from typing import Any

from ._errors import InvalidValue
from ._types import BaseType, Type


def parse_value_string(type_: Type, value_string: str) -> Any:
    """Return the value of a text: of a type without a package, or an array of such values."""
    if not type_.is_primitive_type():
        raise NotImplementedError(f"parsing string values into type '{type_}' is not supported")
    if not type_.is_array:
        return parse_primitive_value_string(type_, value_string)
    if not (value_string.startswith("[") and value_string.endswith("]")):
        raise InvalidValue(type_, value_string, "array value must start with '[' and end with ']'")
    inner = value_string[1:-1]
    if type_.type in ("string", "wstring"):
        items = parse_string_array_value_string(inner, type_.array_size)
    else:
        items = inner.split(",") if inner else []
    size = type_.array_size
    if size and (len(items) > size if type_.is_upper_bound else len(items) != size):
        which = "not more than" if type_.is_upper_bound else "exactly"
        raise InvalidValue(type_, value_string, f"array must have {which} {size} elements, not {len(items)}")
    base = Type(BaseType.__str__(type_))
    values = []
    for index, item in enumerate(items):
        try:
            values.append(parse_primitive_value_string(base, item.strip()))
        except InvalidValue as error:
            raise InvalidValue(type_, value_string, f"element {index} with {error}") from None
    return values


def parse_string_array_value_string(element_string: str, expected_size: int | None = None) -> list[str]:
    """Return the items of a list of texts, which may be in quotes, with these."""
    items = []
    rest = element_string.strip()
    while rest:
        match = re.match(r"""("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,"'][^,]*)\s*(,|$)\s*""", rest)
        if match is None:
            raise ValueError(f"the list of texts '{element_string}' can not be read from '{rest}' on")
        items.append(match[1].strip())
        rest = rest[match.end() :]
    return items


def parse_primitive_value_string(type_: Type, value_string: str) -> Any:
    """Return the value of a text, of a type without a package that is no array.

    Raises
    ------
    InvalidValue
        When the text is not a value of the type.
    """
    if not type_.is_primitive_type() or type_.is_array:
        raise ValueError("the passed type must be a non-array primitive type")
    kind = type_.type
    if kind == "bool":
        values = {"true": True, "1": True, "false": False, "0": False}
        if value_string.lower() not in values:
            raise InvalidValue(kind, value_string, "must be either 'true' / '1' or 'false' / '0'")
        return values[value_string.lower()]
    if kind in ("string", "wstring"):
        return _text(type_, value_string)
    if kind.startswith("float"):
        try:
            return float(value_string)
        except ValueError:
            raise InvalidValue(
                kind, value_string, "must be a floating point number using '.' as the separator"
            ) from None
    return _integer(kind, value_string)


def _integer(kind: str, text: str) -> int:
    if kind in ("byte", "char"):
        low, high = 0, 255
    else:
        match = re.fullmatch(r"(u?)int(\d+)", kind)
        if match is None:
            raise AssertionError(f"unknown primitive type '{kind}'")
        bits = int(match[2])
        low, high = (0, 2**bits - 1) if match[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    expected = f"must be a valid integer value >= {low} and <= {high}"
    try:
        value = int(text) if re.fullmatch(r"\s*[-+]?\d+\s*", text) else int(text, 0)
    except ValueError:
        raise InvalidValue(kind, text, expected) from None
    if not low <= value <= high:
        raise InvalidValue(kind, text, expected)
    return value


def _text(type_: Type, text: str) -> str:
    for quote in ('"', "'"):
        if text.startswith(quote) and text.endswith(quote):
            text = text[1:-1]
            if re.search(rf"(?<!\\){quote}", text):
                raise InvalidValue(type_, text, "string inner quotes not properly escaped")
            text = text.replace(f"\\{quote}", quote)
            break
    bound = type_.string_upper_bound
    if bound and len(text) > bound:
        raise InvalidValue(type_, text, f"string must not exceed the maximum length of {bound} characters")
    return text
