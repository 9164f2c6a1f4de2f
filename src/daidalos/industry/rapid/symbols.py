"""What names stand for: data types, data and routines."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from daidalos.industry.rapid.tree import Alias, Data, For, Name, Parameter, ParameterGroup, Record, Routine

DataKind = Literal["VAR", "PERS", "CONST", "value", "INOUT", "loop"]
"""How data was declared; ``value`` and ``INOUT`` are parameters, ``loop`` the counter of FOR."""


@dataclass(frozen=True)
class Type:
    """A data type, with the number of dimensions of an array of it.

    Attributes
    ----------
    name
        Lower case. ``any`` fits all data, ``number`` num and dnum, ``literal`` is a number that may be either.
    """

    name: str
    dimensions: int = 0

    def __str__(self) -> str:
        return self.name + ("{" + ",".join("*" * self.dimensions) + "}" if self.dimensions else "")


@dataclass
class TypeSymbol:
    """A data type.

    Attributes
    ----------
    kind
        ``atomic``, ``record``, ``alias`` or ``opaque``: an opaque type has no values to assign, compare or write.
    base
        Type that an alias stands for.
    components
        Names and types of a record's components, in their order; None where they are not known.
    """

    name: str
    kind: Literal["atomic", "record", "alias", "opaque"]
    base: str = ""
    components: list[tuple[str, str]] | None = None
    node: Record | Alias | None = None


@dataclass
class DataSymbol:
    """Data of any kind."""

    name: str
    kind: DataKind
    type: Type
    node: Data | Parameter | For | None = None
    is_optional: bool = False
    value: str = ""


@dataclass
class RoutineSymbol:
    """A procedure, function or trap; `groups` is None where its parameters are not known."""

    name: str
    kind: Literal["PROC", "FUNC", "TRAP"]
    groups: list[ParameterGroup] | None
    type: Type | None = None
    node: Routine | None = None
    signature: str = ""


Symbol: TypeAlias = TypeSymbol | DataSymbol | RoutineSymbol


@dataclass
class Owned:
    """A symbol with the place of its name."""

    symbol: Symbol
    file: str
    module: str
    name: Name
    scope: str = ""


@dataclass
class Scope:
    """Names, lower case, and the scope around it."""

    parent: Scope | None = None
    names: dict[str, Owned] = field(default_factory=dict)

    def find(self, key: str) -> Owned | None:
        """Return what a name stands for here, None where it is not declared."""
        scope: Scope | None = self
        while scope is not None:
            found = scope.names.get(key)
            if found is not None:
                return found
            scope = scope.parent
        return None

    def visible(self) -> set[str]:
        """Return all names that can be used here, as they are spelled."""
        names: set[str] = set()
        scope: Scope | None = self
        while scope is not None:
            names.update(owned.symbol.name for owned in scope.names.values())
            scope = scope.parent
        return names


def symbol_of_routine(node: Routine) -> RoutineSymbol:
    """Return the symbol of a routine of the user's."""
    type_ = Type(node.type.key) if node.type else None
    return RoutineSymbol(node.name.text, node.kind, node.groups, type_, node)  # type: ignore[arg-type]


def symbol_of_data(node: Data) -> DataSymbol:
    """Return the symbol of data of the user's."""
    return DataSymbol(node.name.text, node.kind, Type(node.type.key, len(node.dimensions)), node)  # type: ignore[arg-type]


def symbol_of_parameter(node: Parameter, is_optional: bool) -> DataSymbol:
    """Return the symbol of a parameter, as the routine sees it."""
    kind: DataKind = node.mode or "value"  # type: ignore[assignment]
    return DataSymbol(node.name.text, kind, Type(node.type.key, node.dimensions), node, is_optional)


def symbol_of_type(node: Record | Alias) -> TypeSymbol:
    """Return the symbol of a type of the user's."""
    if isinstance(node, Alias):
        return TypeSymbol(node.name.text, "alias", node.type.key, None, node)
    components = [(one.name.key, one.type.key) for one in node.components]
    return TypeSymbol(node.name.text, "record", "", components, node)
