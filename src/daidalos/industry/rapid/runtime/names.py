"""Names in the translated program: how RAPID's data is reached in Python."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from daidalos.industry.rapid import flow, tree
from daidalos.industry.rapid.symbols import DataSymbol, Owned, Type


@dataclass
class Place:
    """How data is reached.

    Attributes
    ----------
    how
        ``global``: a name of the program's namespace. ``local``: a local name. ``box``: a list of one element, so that
        other routines can change it. ``reference``: container and key of a scalar of the caller. ``signal``: by name.
    name
        Python's name.
    """

    how: str
    name: str
    type: Type
    is_scalar: bool
    is_optional: bool = False

    def read(self) -> str:
        """Return the expression that reads it."""
        base = f"_given({self.name}, {self.name[2:]!r})" if self.is_optional else self.name
        if self.how == "box":
            return f"{base}[0]"
        return f"_referred({base})" if self.how == "reference" else base

    def hand_on(self, by_reference: bool) -> str:
        """Return the expression of an optional argument that is handed on where it is present, else None."""
        if self.how == "box":
            return f"({self.name} and {f'({self.name}, 0)' if by_reference else f'{self.name}[0]'})"
        return (
            f"({self.name} and _referred({self.name}))" if self.how == "reference" and not by_reference else self.name
        )

    def reference(self) -> str:
        """Return the expression of a reference to a scalar."""
        if self.how == "global":
            return f"(_G, {self.name!r})"
        if self.how == "box":
            return f"({self.name}, 0)"
        return self.name if self.how == "reference" else f"([{self.name}], 0)"


@dataclass
class Frame:
    """The local data of a routine while it is translated."""

    boxed: set[str]
    places: dict[str, Place] = field(default_factory=dict)
    locals: list[str] = field(default_factory=list)


def global_name(owned: Owned) -> str:
    """Return Python's name of data or a routine of a module."""
    prefix = "d" if isinstance(owned.symbol, DataSymbol) else "r"
    local = f"_{python_name(owned.module.lower())}" if owned.scope == "LOCAL" else ""
    return f"{prefix}{local}_{python_name(owned.name.key)}"


def python_name(key: str) -> str:
    """Return a name without the letters that Python takes for others, such as the two signs for micro."""
    return key if key.isascii() else "".join(one if one.isascii() else f"_{ord(one):x}_" for one in key)


def referenced_names(routine: tree.Routine) -> set[str]:
    """Return the names that a routine hands to calls as a whole, and so may be changed by what it calls."""
    found: set[str] = set()
    bodies = [routine.body, *(handler.body for handler in routine.handlers)]
    for node in (inner for body in bodies for inner in tree.walk(body)):
        if isinstance(node, tree.Argument) and isinstance(node.value, tree.Variable):
            found.add(node.value.name.key)
        elif isinstance(node, tree.Connect) and isinstance(node.target, tree.Variable):
            found.add(node.target.name.key)
    return found


def local_names(routine: tree.Routine) -> set[str]:
    """Return the names of all parameters and local data."""
    bodies = [routine.body, *(handler.body for handler in routine.handlers)]
    data = {node.name.key for body in bodies for node in tree.walk(body) if isinstance(node, tree.Data)}
    return data | {one.name.key for one in routine.parameters()}


def labels(body: list[tree.Statement]) -> Iterator[str]:
    """Yield the labels directly in a list of statements."""
    yield from (one.name.key for one in body if isinstance(one, tree.Label))


def jumps(body: list[tree.Statement]) -> set[str]:
    """Return the labels that a list of statements jumps to."""
    return {one.label.key for one in flow.statements(body) if isinstance(one, tree.Goto)}
