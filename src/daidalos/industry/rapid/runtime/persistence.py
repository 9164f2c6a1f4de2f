"""Persistents written back into the modules that declare them."""

from __future__ import annotations

from pathlib import Path

from daidalos.industry.rapid import tree
from daidalos.industry.rapid.parsing import Parsed
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.runtime.values import text_of
from daidalos.industry.rapid.sources import write_source

DIGITS = 9
"""Digits that numbers are written with, as controllers do."""


def save_persistents(task: Task) -> list[Path]:
    """Write the present values of persistents into their modules, and return the files that have changed.

    Raises
    ------
    UserError
        If a file cannot be written; it then is as it was.
    """
    changed = []
    for parsed in task.modules:
        text = text_with_values(task, parsed)
        if text != parsed.source.text:
            path = Path(parsed.source.file)
            write_source(path, text, parsed.source.encoding)
            changed.append(path)
    return changed


def text_with_values(task: Task, parsed: Parsed) -> str:
    """Return the text of a module with the present values of its persistents."""
    values = {id(node): value for _, node, value in task.persistents()}
    text = parsed.source.text
    nodes = [one for module in parsed.tree.modules for one in module.items if isinstance(one, tree.Data)]
    for node in sorted(nodes, key=lambda one: one.start, reverse=True):
        if id(node) not in values:
            continue
        value = text_of(values[id(node)], DIGITS)
        end = node.end - 1
        if node.value is None:
            text = f"{text[:end]}:={value}{text[end:]}"
        elif "".join(text[node.value.start : end].split()) != "".join(value.split()) and _differs(node, value):
            text = f"{text[: node.value.start]}{value}{text[end:]}"
    return text


def _differs(node: tree.Data, value: str) -> bool:
    """Return whether a value is another one than that which is written, and not only written in another way."""
    from daidalos.industry.rapid.literals import parse_literals

    written = node.value
    if isinstance(written, tree.Literals | tree.Number | tree.String | tree.Boolean):
        before = written.text if not isinstance(written, tree.Boolean) else str(written.value)
        return text_of(parse_literals(f"[{before}]")[0], DIGITS) != value
    return True
