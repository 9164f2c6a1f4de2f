"""Definitions with all their dependencies as one text: the ``ros2msg`` schemas of MCAP and Foxglove."""

from __future__ import annotations

from daidalos.interfaces.definition import Message
from daidalos.interfaces.library import Library, definition_text

_SEPARATOR = "=" * 80


def message_schema(name: str, library: Library) -> str:
    """Return the definition of a message, or of a part such as ``pkg/srv/X_Request``, with its dependencies.

    Raises
    ------
    InterfaceNotFound
        When the message or one that it refers to has no definition.
    """
    texts = [_text(name, library)]
    seen = {name}
    pending = _nested(name, library)
    while pending:
        other = pending.pop(0)
        if other in seen:
            continue
        seen.add(other)
        package, _, short = other.split("/")
        texts.append(f"{_SEPARATOR}\nMSG: {package}/{short}\n{_text(other, library)}")
        pending += _nested(other, library)
    return "\n\n".join(text.rstrip("\n") for text in texts) + "\n"  # a blank line, as rosbag2 writes it


def _nested(name: str, library: Library) -> list[str]:
    interface = library.get(name)
    return list(interface.nested()) if isinstance(interface, Message) else []


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
        return "\n".join(sections[parts.index(part)])
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
    return "\n".join(lines)
