"""Parser of .msg, .srv and .action text (ROS 2's interface definition language)."""

from __future__ import annotations

import math
import re
from pathlib import Path

from daidalos.common.errors import Location, UserError
from daidalos.interfaces.definition import (
    INTEGER_RANGES,
    PRIMITIVES,
    Action,
    Constant,
    Field,
    FieldType,
    Interface,
    Kind,
    Literal,
    Message,
    Service,
)


class InterfaceError(UserError, ValueError):
    """Invalid interface file; the message names file and line."""


_TYPE = re.compile(r"(?P<base>[A-Za-z][\w/]*)(?:<=(?P<bound>\d+))?(?P<array>\[(?P<upto><=)?(?P<size>\d*)\])?$")
_FIELD_NAME = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*$")
_CONSTANT_NAME = re.compile(r"[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*$")
_NAME = re.compile(r"[A-Z][A-Za-z0-9]*$")
_FLOAT32_MAX = 3.4028234663852886e38
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def parse_file(path: Path, package: str) -> Interface:
    """Read an interface file; the suffix determines its type.

    Raises
    ------
    InterfaceError
        Naming the file and the line that cannot be understood.
    """
    kind = path.suffix.lstrip(".")
    if kind not in {"msg", "srv", "action"}:
        raise InterfaceError("expected a .msg, .srv or .action file", Location(str(path)))
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise InterfaceError(f"byte {error.start} is not valid UTF-8", Location(str(path))) from None
    return parse(text, package, kind, path.stem, str(path))


def parse(text: str, package: str, kind: str, name: str, source: str = "<text>") -> Interface:
    """Parse the text of an interface called ``package/kind/name``.

    Raises
    ------
    InterfaceError
        Naming `source` and the line that cannot be understood.
    """
    if not _NAME.match(name):
        raise InterfaceError(f"'{name}' is not an interface name; use CamelCase such as 'LaserScan'", Location(source))
    full = f"{package}/{kind}/{name}"
    lines = text.splitlines()
    if kind == "msg":
        return _parse_message(full, lines, 1, source, package)
    parts: list[tuple[int, list[str]]] = [(1, [])]
    for number, line in enumerate(lines, 1):
        if line.strip() == "---":
            parts.append((number + 1, []))
        else:
            parts[-1][1].append(line)
    suffixes = ("Request", "Response") if kind == "srv" else ("Goal", "Result", "Feedback")
    if len(parts) != len(suffixes):
        raise InterfaceError(
            f"a .{kind} file has {len(suffixes)} parts separated by '---', this one {len(parts)}", Location(source)
        )
    messages = [
        _parse_message(f"{full}_{suffix}", part, first, source, package)
        for suffix, (first, part) in zip(suffixes, parts, strict=True)
    ]
    return Service(full, *messages) if kind == "srv" else Action(full, *messages)


def _parse_message(name: str, lines: list[str], first: int, source: str, package: str) -> Message:
    fields: list[Field] = []
    constants: list[Constant] = []
    pending: list[str] = []
    header: str | None = None
    for number, raw in enumerate(lines, first):
        code, comment = _split_comment(raw)
        if not code:
            if comment is not None:
                pending.append(comment)
            elif header is None and not fields and not constants:
                header, pending = "\n".join(pending), []
            else:
                pending = []
            continue
        note = "\n".join([*pending, *([comment] if comment else [])])
        pending = []
        try:
            item = _parse_line(code, note, package)
        except InterfaceError as error:
            raise InterfaceError(str(error), Location(source, number)) from None
        if item.name in {other.name for other in fields} | {other.name for other in constants}:
            raise InterfaceError(f"'{item.name}' is defined twice", Location(source, number))
        if isinstance(item, Constant):
            constants.append(item)
        else:
            fields.append(item)
    return Message(name, tuple(fields), tuple(constants), header or "")


def _split_comment(line: str) -> tuple[str, str | None]:
    """Split a line into code and comment; a '#' within quotes does not start a comment."""
    quote, escaped = "", False
    for i, char in enumerate(line):
        if escaped:
            escaped = False
        elif quote:
            escaped = char == "\\"
            quote = "" if char == quote else quote
        elif char in "'\"" and line[i - 1 : i] in {"", " ", "\t", "=", ",", "["}:
            quote = char
        elif char == "#":
            return line[:i].strip(), line[i + 1 :].strip()
    if quote and "#" in line:  # not closed: no quoted string
        return line[: line.index("#")].strip(), line[line.index("#") + 1 :].strip()
    return line.strip(), None


def _parse_line(code: str, comment: str, package: str) -> Field | Constant:
    type_text, *others = code.split(maxsplit=1)
    rest = others[0] if others else ""
    field_type = _parse_type(type_text, package)
    if not rest:
        raise InterfaceError(f"'{code}' has a type but no name")
    name = re.split(r"[\s=]", rest, maxsplit=1)[0]
    tail = rest[len(name) :].strip()
    if tail.startswith("=") and not tail.startswith("=="):
        return _parse_constant(field_type, name, tail[1:].strip(), comment)
    if not _FIELD_NAME.match(name):
        raise InterfaceError(f"'{name}' is not a field name; use lower case words joined by single underscores")
    default = _parse_default(field_type, tail) if tail else None
    return Field(field_type, name, default, comment)


def _parse_constant(field_type: FieldType, name: str, text: str, comment: str) -> Constant:
    if not _CONSTANT_NAME.match(name):
        raise InterfaceError(f"'{name}' is not a constant name; use upper case words joined by underscores")
    if field_type.kind is not Kind.SINGLE or not field_type.is_primitive:
        raise InterfaceError(f"constant '{name}' must have a primitive type")
    return Constant(field_type, name, _parse_value(field_type, text), comment)


def _parse_type(text: str, package: str) -> FieldType:
    match = _TYPE.match(text)
    if not match:
        raise InterfaceError(f"'{text}' is not a type")
    base, bound = match["base"], match["bound"]
    if base == "Header":
        base = "std_msgs/msg/Header"
    elif base not in PRIMITIVES:
        base = _full_name(base, package)
    if bound is not None and base not in {"string", "wstring"}:
        raise InterfaceError(f"'{text}': only strings have a bound of their own")
    kind, size = Kind.SINGLE, 0
    if match["array"]:
        size = int(match["size"] or 0)
        kind = Kind.BOUNDED if match["upto"] else Kind.ARRAY if match["size"] else Kind.UNBOUNDED
        if kind is not Kind.UNBOUNDED and size == 0:
            raise InterfaceError(f"'{text}': the size must be at least 1")
    return FieldType(base, kind, size, int(bound) if bound is not None else None)


def _full_name(base: str, package: str) -> str:
    parts = base.split("/")
    if len(parts) == 1 and base in {"time", "duration"}:
        raise InterfaceError(f"'{base}' is ROS 1's: use builtin_interfaces/{base.capitalize()}")
    if len(parts) > 3 or not _NAME.match(parts[-1]):
        raise InterfaceError(f"'{base}' is not a type: expected a primitive, 'Name' or 'package/Name'")
    if len(parts) == 3:
        return base
    return f"{parts[0] if len(parts) == 2 else package}/msg/{parts[-1]}"


def _parse_default(field_type: FieldType, text: str) -> Literal:
    if not field_type.is_primitive:
        raise InterfaceError(f"a field of type '{field_type.base}' takes no default")
    if field_type.kind is Kind.SINGLE:
        return _parse_value(field_type, text)
    if not (text.startswith("[") and text.endswith("]")):
        raise InterfaceError(f"the default of an array is written in brackets, not '{text}'")
    values = [_parse_value(field_type, item) for item in _split_items(text[1:-1])]
    if field_type.kind is Kind.ARRAY and len(values) != field_type.size:
        raise InterfaceError(f"the default has {len(values)} values, the array {field_type.size}")
    if field_type.kind is Kind.BOUNDED and len(values) > field_type.size:
        raise InterfaceError(f"the default has {len(values)} values, the bound is {field_type.size}")
    return values  # type: ignore[return-value]


def _split_items(text: str) -> list[str]:
    items = re.findall(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,]+?)\s*(?:,|$)""", text)
    return [item for item in items if item]


def _parse_value(field_type: FieldType, text: str) -> bool | int | float | str:
    base = field_type.base
    if base in {"string", "wstring"}:
        return _parse_string(field_type, text)
    if base == "bool":
        truth = {"true": True, "false": False, "1": True, "0": False}.get(text.lower())
        if truth is None:
            raise InterfaceError(f"'{text}' is not a bool: expected true or false")
        return truth
    if base in {"float32", "float64"}:
        try:
            value = float(text)
        except ValueError:
            raise InterfaceError(f"'{text}' is not a valid {base}") from None
        if base == "float32" and math.isfinite(value) and abs(value) > _FLOAT32_MAX:
            raise InterfaceError(f"{text} is out of range for float32")
        return value
    try:
        number = int(text) if text.lstrip("+-").isdigit() else int(text, 0)
    except ValueError:
        raise InterfaceError(f"'{text}' is not a valid {base}") from None
    low, high = INTEGER_RANGES[base]
    if not low <= number <= high:
        raise InterfaceError(f"{text} is out of range for {base} ({low} to {high})")
    return number


def _parse_string(field_type: FieldType, text: str) -> str:
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "'\"":
        if re.search(rf"(?<!\\){text[0]}", text[1:-1]):
            raise InterfaceError(f"the string {text} has a quote inside that needs a backslash")
        text = re.sub(r"\\([\\'\"ntr])", lambda match: _ESCAPES.get(match[1], match[1]), text[1:-1])
    elif text[:1] in {"'", '"'}:
        raise InterfaceError(f"the string {text} is not closed")
    if field_type.string_bound is not None and len(text) > field_type.string_bound:
        raise InterfaceError(f"the string '{text}' is longer than its bound {field_type.string_bound}")
    return text
