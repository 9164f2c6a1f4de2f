"""Writer of .idl files with the contents of .msg, .srv and .action files.

The mapping of types, names and comments is that of
https://design.ros2.org/articles/legacy_interface_definition.html.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ._errors import InvalidSpecification, InvalidValue
from ._specifications import ActionSpecification, MessageSpecification, ServiceSpecification
from ._types import BaseType, Type
from .parser import parse_action_string, parse_message_string, parse_service_string

MSG_TYPE_TO_IDL = {
    "bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double",
    **{f"{sign}int{bits}": f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
    "string": "string", "wstring": "wstring",
}  # fmt: skip
"""IDL's names of the types without a package."""


def convert(kind: str, package_dir: Path, package_name: str, input_file: Path, output_dir: Path) -> Path:
    """Write the .idl file of an interface file and return its path; one that would not change is not touched.

    Parameters
    ----------
    kind
        ``msg``, ``srv`` or ``action``, which the file must be.
    package_dir
        The package's folder, absolute.
    package_name
        The package's name.
    input_file
        The file, relative to `package_dir`.
    output_dir
        Folder to write to.

    Raises
    ------
    ValueError
        When the paths or the file's contents are not as expected.
    """
    if kind not in ("msg", "srv", "action") or input_file.suffix != f".{kind}":
        raise ValueError(f"'{input_file}': expected a .msg, .srv or .action file")
    if not package_dir.is_absolute() or input_file.is_absolute():
        raise ValueError(f"expected an absolute folder and a relative file, got '{package_dir}' and '{input_file}'")
    path = package_dir / input_file
    try:
        text = idl_text(kind, package_name, input_file, path.read_text(encoding="utf-8"))
    except (InvalidSpecification, InvalidValue, NameError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: {error}") from error
    output = output_dir / f"{input_file.stem}.idl"
    if not output.is_file() or output.read_text(encoding="utf-8") != text:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text, encoding="utf-8")
    return output


def idl_text(kind: str, package: str, file: Path, text: str) -> str:
    """Return the text of the .idl file.

    Parameters
    ----------
    kind, package
        ``msg``, ``srv`` or ``action``, and the package's name.
    file
        Path that the heading names, relative to the package.
    text
        Contents of the file.
    """
    messages = _messages(kind, package, file.stem, text)
    included = {get_include_file(field.type) for message in messages for field in message.fields}
    lines = [
        f"// generated from rosidl_adapter/resource/{kind}.idl.em",
        f"// with input from {package}/{file.as_posix()}",
        "// generated code does not contain a copyright notice",
        "",
        *(f'#include "{path}"' for path in sorted(path for path in included if path)),
        "",
        f"module {package} {{",
        f"  module {kind} {{",
        *(line for message in messages for line in _struct(message)),
        "  };",
        "};",
    ]
    return "\n".join(lines) + "\n"


def _messages(kind: str, package: str, name: str, text: str) -> Sequence[MessageSpecification]:
    found: ServiceSpecification | ActionSpecification
    if kind == "msg":
        return [parse_message_string(package, name, text)]
    if kind == "srv":
        found = parse_service_string(package, name, text)
        return [found.request, found.response]
    found = parse_action_string(package, name, text)
    return [found.goal, found.result, found.feedback]


def get_include_file(base_type: BaseType) -> str | None:
    """Return the .idl file that defines a type, None for one without a package."""
    return None if base_type.is_primitive_type() else f"{base_type.pkg_name}/msg/{base_type.type}.idl"


def get_idl_type(type_: str | Type) -> str:
    """Return a type as IDL spells it; a fixed array as ``double[3]``, which is not one of IDL's notations."""
    if isinstance(type_, str):
        return MSG_TYPE_TO_IDL[type_]
    if type_.is_primitive_type():
        name = MSG_TYPE_TO_IDL[type_.type]
        name += f"<{type_.string_upper_bound}>" if type_.string_upper_bound is not None else ""
    else:
        name = f"{type_.pkg_name}::msg::{type_.type}"
    if not type_.is_array:
        return name
    if type_.is_fixed_size_array():
        return f"{name}[{type_.array_size}]"
    return f"sequence<{name}, {type_.array_size}>" if type_.is_upper_bound else f"sequence<{name}>"


def to_idl_literal(idl_type: str, value: Any) -> str:
    """Return a value as IDL spells it; the values of arrays are a text with a tuple in it."""
    if idl_type.endswith("]") or idl_type.startswith("sequence<"):
        content = repr(tuple(value)).replace("\\", r"\\").replace('"', r"\"")
        return f'"{content}"'
    if idl_type == "boolean":
        return "TRUE" if value else "FALSE"
    return string_to_idl_string_literal(value) if idl_type.startswith(("string", "wstring")) else str(value)


def string_to_idl_string_literal(string: str) -> str:
    """Return a text as a literal of IDL; escape sequences in it become what they stand for, as in ROS 2's files."""
    try:
        # unicode_escape decodes bytes as Latin-1: its result has a character for each byte of UTF-8.
        string = string.encode().decode("unicode_escape").encode("latin-1").decode()
    except UnicodeError:
        string = string.replace("\\", r"\\")
    return '"{}"'.format(string.replace('"', r"\""))


def _struct(message: MessageSpecification) -> Iterator[str]:
    for alias, base in _typedefs(message):
        yield f"    typedef {base} {alias};"
    if message.constants:
        yield f"    module {message.msg_name}_Constants {{"
        for constant in message.constants:
            # rosidl's template leaves the lines of a constant's comment on one line.
            yield from _verbatim(constant, "      ", separator="")
            kind = get_idl_type(constant.type)
            yield f"      const {kind} {constant.name} = {to_idl_literal(kind, constant.value)};"
        yield "    };"
    yield from _verbatim(message, "    ")
    yield f"    struct {message.msg_name} {{"
    if not message.fields:
        yield "      uint8 structure_needs_at_least_one_member;"
    for index, field in enumerate(message.fields):
        if index:
            yield ""
        yield from _verbatim(field, "      ")
        kind = get_idl_type(field.type)
        if field.default_value is not None:
            yield f"      @default (value={to_idl_literal(kind, field.default_value)})"
        if "unit" in field.annotations:
            yield f"      @unit (value={string_to_idl_string_literal(field.annotations['unit'])})"
        yield f"      {_identifier(kind) if field.type.is_fixed_size_array() else kind} {field.name};"
    yield "    };"


def _typedefs(message: MessageSpecification) -> Iterator[tuple[str, str]]:
    """Yield alias and type of the fixed arrays, and of the messages in these; IDL has no arrays in structs."""
    seen = set()
    for field in message.fields:
        if not field.type.is_fixed_size_array():
            continue
        kind = get_idl_type(field.type)
        base = kind.partition("[")[0]
        plain = base.replace("::", "__")
        for alias, of in ((plain, base), (f"{_identifier(kind)}[{field.type.array_size}]", plain)):
            if alias != of and alias not in seen:
                seen.add(alias)
                yield alias, of


def _identifier(idl_type: str) -> str:
    return re.sub(r"[>\]]", "", re.sub(r"::|[<\[]", "__", idl_type))


def _verbatim(element: Any, indent: str, separator: str = "\n") -> Iterator[str]:
    comment = [string_to_idl_string_literal(line) for line in element.annotations.get("comment", [])]
    if comment:
        yield f'{indent}@verbatim (language="comment", text='
        lines = f' "\\n"{separator}'.join(f"{indent}  {line}" for line in comment)
        yield f"{lines})"
