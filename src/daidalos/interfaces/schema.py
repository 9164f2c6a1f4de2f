"""Definitions with all their dependencies as one text, as the schemas of MCAP, rosbag2 and Foxglove have them.

The encodings ``ros2msg`` and ``ros2idl`` are those of https://mcap.dev/spec/registry.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from daidalos.interfaces.definition import Action, Message, Service
from daidalos.interfaces.library import InterfaceNotFound, Library, definition_text

_INCLUDE = re.compile(r'^#include\s+["<]([\w/]+)\.idl[">]', re.MULTILINE)
_SEPARATOR = "=" * 80


class Schema(NamedTuple):
    """Text of a schema and its encoding, ``ros2msg``, ``ros2idl`` or ``unknown``."""

    text: str
    encoding: str


def message_schema(name: str, library: Library) -> str:
    """Return the definition of a message, or of a part such as ``pkg/srv/X_Request``, with its dependencies.

    Raises
    ------
    InterfaceNotFound
        When the message or one that it refers to has no definition.
    """
    return _msg(name, library, {name})


def bag_schema(name: str, library: Library) -> Schema:
    """Return the definition of a type as rosbag2 writes it.

    A message is ``ros2msg``, or ``ros2idl`` if it or one that it refers to is defined by an .idl file. A service has
    the text of its .srv file, and the encoding of the messages that it refers to; without any, it is ``unknown``.

    Parameters
    ----------
    name
        ``package/Name``, ``package/msg/Name`` or ``package/srv/Name``.
    library
        Where definitions are.

    Raises
    ------
    InterfaceNotFound
        When the type or one that it refers to has no definition, or is an action.
    """
    package, _, short = name.partition("/")
    full = name if "/" in short else f"{package}/msg/{short}"
    interface = library.get(full)
    if isinstance(interface, Action):
        raise InterfaceNotFound(f"'{name}' is an action, which has no messages of its own")
    if isinstance(interface, Service):
        return _service_schema(name, interface, library)
    if _is_in_idl(full, library):
        return Schema(f"{_SEPARATOR}\nIDL: {name}\n{_idl(full, library, {full})}", "ros2idl")
    return Schema(message_schema(full, library), "ros2msg")


def _service_schema(name: str, service: Service, library: Library) -> Schema:
    text = f"{_SEPARATOR}\nSRV: {name}\n{definition_text(library.path(name))}"
    encoding = "unknown"
    seen: set[str] = set()
    for other in sorted({*service.request.nested(), *service.response.nested()}):
        if other in seen:
            continue
        seen.add(other)
        text += f"\n{_heading('MSG', other)}"
        if _is_in_idl(other, library):
            # rosbag2 keeps the heading of the .msg file that it has looked for first.
            text += f"\n{_heading('IDL', other)}{_idl(other, library, seen)}"
            encoding = "ros2idl"
        else:
            text += _msg(other, library, seen)
            encoding = "ros2msg"
    return Schema(text, encoding)


def _heading(form: str, name: str) -> str:
    package, _, short = name.split("/")
    return f"{_SEPARATOR}\n{form}: {package}/{short}\n"


def _msg(name: str, library: Library, seen: set[str]) -> str:
    """Return the .msg text of a message, followed by those of the messages it refers to that are not in `seen`."""
    text = _text(name, library)
    for other in _nested(name, library):
        if other not in seen:
            seen.add(other)
            text += f"\n{_heading('MSG', other)}{_msg(other, library, seen)}"
    return text


def _idl(name: str, library: Library, seen: set[str]) -> str:
    """Return the .idl text of a message, followed by those of the messages it refers to that are not in `seen`."""
    text = _idl_text(name, library)
    for other in sorted({*_INCLUDE.findall(text), *_nested(name, library)}):
        if other not in seen:
            seen.add(other)
            text += f"\n{_SEPARATOR}\nIDL: {other}\n{_idl(other, library, seen)}"
    return text


def _idl_text(name: str, library: Library) -> str:
    from rosidl_adapter.idl import idl_text  # absent while the package is built

    path = library.path(name)
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".idl":
        return text
    return idl_text("msg", name.split("/")[0], Path("msg", path.name), text)


def _is_in_idl(name: str, library: Library) -> bool:
    """Return whether a message or one that it refers to is defined by an .idl file."""
    pending, seen = [name], {name}
    while pending:
        one = pending.pop()
        package, kind, short = one.split("/")
        if library.path(f"{package}/{kind}/{short.partition('_')[0]}").suffix == ".idl":
            return True
        pending += [other for other in _nested(one, library) if other not in seen]
        seen.update(pending)
    return False


def _nested(name: str, library: Library) -> list[str]:
    """Return the messages that a message refers to, sorted by name."""
    interface = library.get(name)
    return sorted(set(interface.nested())) if isinstance(interface, Message) else []


def _text(name: str, library: Library) -> str:
    """Return the text that defines a message: a file, or the part of one between its ``---`` lines."""
    package, kind, short = name.split("/")
    if kind == "msg":
        return definition_text(library.path(name))
    base, _, part = short.partition("_")
    parts = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}[kind]
    if part in parts:
        sections = [[]]  # type: list[list[str]]
        for line in definition_text(library.path(f"{package}/{kind}/{base}")).splitlines():
            if line.strip() == "---":
                sections.append([])
            else:
                sections[-1].append(line)
        return "".join(f"{line}\n" for line in sections[parts.index(part)])
    return _written_out(name, library)


def _written_out(name: str, library: Library) -> str:
    """Return a definition for a message without a text of its own, such as an action's feedback message."""
    interface = library.get(name)
    fields = interface.fields if isinstance(interface, Message) else ()
    lines = []
    for field in fields:
        base = field.type.base
        if not field.type.is_primitive:
            package, _, short = base.split("/")
            base = f"{package}/{short}"
        many = {"single": "", "array": f"[{field.type.size}]", "bounded": f"[<={field.type.size}]", "unbounded": "[]"}
        lines.append(f"{base}{many[field.type.kind.value]} {field.name}")
    return "".join(f"{line}\n" for line in lines)
