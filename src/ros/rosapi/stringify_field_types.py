"""Definition of a message with those of its fields, in one text."""

from __future__ import annotations

from pathlib import Path

from rosidl_adapter.parser import parse_message_string
from rosidl_runtime_py import get_interface_path

_LINE = "=" * 80


def stringify_field_types(root_type: str) -> str:
    """Return the definition of a message, and after a line each that of a type which it is made of.

    Parameters
    ----------
    root_type
        Name such as ``std_msgs/String`` or ``std_msgs/msg/String``.
    """
    text, waiting, seen = "", [root_type], set[str]()
    while waiting:
        package, *_, name = (one := waiting.pop()).split("/")
        if text:
            text += f"\n{_LINE}\nMSG: {one}\n"
        definition = Path(get_interface_path(f"{package}/msg/{name}")).read_text(encoding="utf-8")
        text += definition
        for field in parse_message_string(package, name, definition).fields:
            kind = f"{field.type.pkg_name}/{field.type.type}"
            if field.type.pkg_name is not None and kind not in seen:
                seen.add(kind)
                waiting.append(kind)
    return text
