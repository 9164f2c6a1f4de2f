"""Data of a stopped task: its names, its values as they are written in RAPID, and new values for it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from daidalos.industry.rapid.debugging.debugger import Call
from daidalos.industry.rapid.literals import parse_literals
from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.names import python_name
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.runtime.values import text_of
from daidalos.industry.rapid.symbols import Type
from daidalos.industry.rapid.tree import Data, walk

_PATH = re.compile(r"\s*(\w+)((?:\s*\.\s*\w+|\s*\{[\d\s,]+\})*)\s*")
_STEP = re.compile(r"\.\s*(\w+)|\{([\d\s,]+)\}")
_LITERAL = re.compile(r'\s*(?:[-+]?[\d.].*|".*"|TRUE|FALSE|\[.*\])\s*', re.IGNORECASE | re.DOTALL)


@dataclass(frozen=True)
class Item:
    """Data, or a part of it.

    Attributes
    ----------
    name
        As it is declared; ``{2}`` for an element.
    type
        Its type.
    container, key
        Where its value is.
    task
        Knows the types.
    """

    name: str
    type: Type
    container: Any
    key: Any
    task: Task

    @property
    def value(self) -> Any:
        """Return the value as the runtime has it."""
        return self.container[self.key]

    @property
    def text(self) -> str:
        """Return the value as it is written in RAPID."""
        return text_of(self.value)

    def parts(self) -> list[Item]:
        """Return the components of a record, or the elements of an array."""
        value = self.value
        if not isinstance(value, list):
            return []
        if self.type.dimensions:
            inner = Type(self.type.name, self.type.dimensions - 1)
            return [Item(f"{{{i}}}", inner, value, i - 1, self.task) for i in range(1, len(value) + 1)]
        components = self.task.types.components(self.type) or [(f"{i}", "num") for i in range(1, len(value) + 1)]
        return [Item(name, Type(type_), value, i, self.task) for i, (name, type_) in enumerate(components)]

    def set(self, text: str) -> None:
        """Assign a value that is written in RAPID.

        Raises
        ------
        ValueError
            Where the text is no value of the type.
        """
        if not _LITERAL.fullmatch(text):
            raise ValueError(f"'{text}' is no value; write numbers, strings, TRUE, FALSE and lists as in RAPID")
        try:
            (value,) = parse_literals(f"[{text.strip()}]")
        except (ValueError, IndexError, SyntaxError) as error:
            raise ValueError(f"'{text}' is no value of {self.type}") from error
        if not _fits(self.value, value):
            raise ValueError(f"'{text}' is no value of {self.type}, such as {self.text}")
        if isinstance(value, list):
            self.value[:] = value
        else:
            self.container[self.key] = value


def _fits(old: Any, new: Any) -> bool:
    if isinstance(old, list):
        return isinstance(new, list) and len(old) == len(new) and all(map(_fits, old, new))
    return type(old) is type(new) or (isinstance(old, float) and isinstance(new, float))


def local_data(task: Task, call: Call) -> list[Item]:
    """Return parameters and local data of a call that are present."""
    routine = task.routine_at(call.file, call.line)
    if routine is None:
        return []
    declared = [(one.name, one.type.key, one.dimensions, "a") for one in routine.parameters()]
    bodies = [routine.body, *(handler.body for handler in routine.handlers)]
    data = (one for one in walk(bodies) if isinstance(one, Data))
    declared += [(one.name, one.type.key, len(one.dimensions), "v") for one in data]
    found = []
    for name, type_, dimensions, letter in declared:
        value = call.frame.f_locals.get(f"{letter}_{python_name(name.key)}")
        if value is None:
            continue
        type_of = Type(type_, dimensions)
        if isinstance(value, tuple):
            found.append(Item(name.text, type_of, value[0], value[1], task))
        elif isinstance(value, list) and task.is_scalar(type_of):
            found.append(Item(name.text, type_of, value, 0, task))
        else:
            found.append(Item(name.text, type_of, [value], 0, task))
    return found


def module_data(task: Task) -> Iterator[tuple[str, Item]]:
    """Yield all data of modules, each with the name of its module."""
    for module, symbol, key in task.stored_data():
        yield module, Item(symbol.name, symbol.type, task.store, key, task)


def find(task: Task, call: Call, text: str) -> Item:
    """Return data, a component or an element by how it is written, such as ``p1.trans.x`` or ``parts{2}``.

    Raises
    ------
    ValueError
        Where there is none.
    """
    match = _PATH.fullmatch(text)
    if match is None:
        raise ValueError(f"'{text}' is no data; write a name, with .component or {{index}} behind it")
    known = {one.name.lower(): one for _, one in module_data(task)}
    known |= {one.name.lower(): one for one in local_data(task, call)}
    item = known.get(match[1].lower())
    if item is None:
        raise ValueError(f"there is no data '{match[1]}' here")
    for component, indices in _STEP.findall(match[2]):
        for name in [component] if component else [f"{{{int(one)}}}" for one in indices.split(",")]:
            part = next((one for one in item.parts() if one.name.lower() == name.lower()), None)
            if part is None:
                raise ValueError(f"'{text}': {item.type} has no '{name}'")
            item = part
    return item


def condition_of(task: Task, text: str, top: Any) -> Any:
    """Return the function of a breakpoint's condition: data of type bool, or data compared with a value.

    Raises
    ------
    ValueError
        Where it is neither.
    """
    parts = re.split(r"(<=|>=|<>|=|<|>)", text)
    if len(parts) not in (1, 3):
        raise ValueError(f"'{text}': a condition is a name, or a name compared with a value, such as n > 3")

    def holds() -> bool:
        left = find(task, top(), parts[0]).value
        if len(parts) == 1:
            return bool(left)
        right = parse_literals(f"[{parts[2].strip()}]")[0]
        try:
            return bool(_COMPARISONS[parts[1]](left, right))
        except TypeError as error:
            raise RapidError("ERR_ARGVALERR", str(error)) from None

    return holds


_COMPARISONS = {
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}
