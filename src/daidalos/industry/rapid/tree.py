"""Syntax tree of RAPID: what `parsing.py` builds and all others read.

Every node has ``start``, its offset into the text; statements and declarations also have ``end``. Identifiers keep
their spelling in `Name.text`; `Name.key` is what they are compared by, since upper and lower case are the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields
from typing import TypeAlias


class Name:
    """An identifier at a place."""

    __slots__ = ("key", "start", "text")

    def __init__(self, text: str, start: int) -> None:
        self.text = text
        self.key = text.lower()
        self.start = start

    @property
    def end(self) -> int:
        """The offset behind the identifier."""
        return self.start + len(self.text)

    def __repr__(self) -> str:
        return f"Name({self.text!r}, {self.start})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Name) and other.key == self.key

    def __hash__(self) -> int:
        return hash(self.key)


# Expressions


@dataclass(slots=True)
class Number:
    """Number literal, as it is written."""

    start: int
    text: str


@dataclass(slots=True)
class String:
    """String literal with its quotes, as it is written."""

    start: int
    text: str


@dataclass(slots=True)
class Boolean:
    """``TRUE`` or ``FALSE``."""

    start: int
    value: bool


@dataclass(slots=True)
class Literals:
    """Aggregate of literals only, nested or not, as it is written."""

    start: int
    text: str


@dataclass(slots=True)
class Aggregate:
    """``[a, b, c]``: a record or an array."""

    start: int
    items: list[Expression]


@dataclass(slots=True)
class Variable:
    """Data by its name."""

    name: Name

    @property
    def start(self) -> int:
        """The offset of the name."""
        return self.name.start


@dataclass(slots=True)
class Component:
    """``of.name``."""

    of: Expression
    name: Name

    @property
    def start(self) -> int:
        """The offset of the record."""
        return self.of.start


@dataclass(slots=True)
class Index:
    """``of{i, j}``, counted from 1."""

    of: Expression
    indices: list[Expression]

    @property
    def start(self) -> int:
        """The offset of the array."""
        return self.of.start


@dataclass(slots=True)
class Call:
    """Call of a function."""

    name: Name
    arguments: list[Argument]
    end: int

    @property
    def start(self) -> int:
        """The offset of the function's name."""
        return self.name.start


@dataclass(slots=True)
class Unary:
    """``NOT``, ``+`` or ``-`` before an expression."""

    start: int
    operator: str
    operand: Expression


@dataclass(slots=True)
class Binary:
    """Two expressions with an operator between them, which stands at ``at``."""

    operator: str
    left: Expression
    right: Expression
    at: int

    @property
    def start(self) -> int:
        """The offset of the left expression."""
        return self.left.start


@dataclass(slots=True)
class Placeholder:
    """Something that is still to be written, such as ``<SMT>``."""

    start: int
    text: str

    @property
    def end(self) -> int:
        """The offset behind it."""
        return self.start + len(self.text)


Expression: TypeAlias = (
    "Number | String | Boolean | Literals | Aggregate | Variable | Component | Index | Call | Unary | Binary "
    "| Placeholder"
)


@dataclass(slots=True)
class Argument:
    r"""Argument of a call.

    Attributes
    ----------
    name
        Name of the parameter; None for a required argument by its place.
    value
        Its value; None for a switch.
    is_optional
        Whether it is written with a backslash.
    is_conditional
        Whether it is handed on only where it is present: ``\name?value``.
    """

    start: int
    name: Name | None
    value: Expression | None
    is_optional: bool = False
    is_conditional: bool = False


# Statements


@dataclass(slots=True)
class Assignment:
    """``target := value;``."""

    target: Expression
    value: Expression
    end: int

    @property
    def start(self) -> int:
        """The offset of the target."""
        return self.target.start


@dataclass(slots=True)
class CallStatement:
    """Call of a procedure."""

    name: Name
    arguments: list[Argument]
    end: int

    @property
    def start(self) -> int:
        """The offset of the procedure's name."""
        return self.name.start


@dataclass(slots=True)
class LateCall:
    """Call of the procedure that a string names: ``%name% arguments;``."""

    start: int
    name: Expression
    arguments: list[Argument]
    end: int


@dataclass(slots=True)
class Label:
    """``name:``."""

    name: Name
    end: int

    @property
    def start(self) -> int:
        """The offset of the name."""
        return self.name.start


@dataclass(slots=True)
class Goto:
    """``GOTO label;``."""

    start: int
    label: Name
    end: int


@dataclass(slots=True)
class Return:
    """``RETURN value;``."""

    start: int
    value: Expression | None
    end: int


@dataclass(slots=True)
class Raise:
    """``RAISE number;``."""

    start: int
    value: Expression | None
    end: int


@dataclass(slots=True)
class Retry:
    """``RETRY;``."""

    start: int
    end: int


@dataclass(slots=True)
class TryNext:
    """``TRYNEXT;``."""

    start: int
    end: int


@dataclass(slots=True)
class Exit:
    """``EXIT;``."""

    start: int
    end: int


@dataclass(slots=True)
class Connect:
    """``CONNECT target WITH trap;``."""

    start: int
    target: Expression
    trap: Name
    end: int


@dataclass(slots=True)
class Branch:
    """``IF`` or ``ELSEIF`` with a condition and its statements."""

    start: int
    condition: Expression
    body: list[Statement]


@dataclass(slots=True)
class If:
    """``IF``, with ``ENDIF`` or, where ``is_compact``, with one statement."""

    start: int
    branches: list[Branch]
    otherwise: list[Statement] | None
    end: int
    is_compact: bool = False


@dataclass(slots=True)
class For:
    """``FOR name FROM first TO last STEP step DO``."""

    start: int
    name: Name
    first: Expression
    last: Expression
    step: Expression | None
    body: list[Statement]
    end: int


@dataclass(slots=True)
class While:
    """``WHILE condition DO``."""

    start: int
    condition: Expression
    body: list[Statement]
    end: int


@dataclass(slots=True)
class Case:
    """``CASE values:``, or ``DEFAULT:`` where ``values`` is None."""

    start: int
    values: list[Expression] | None
    body: list[Statement]


@dataclass(slots=True)
class Test:
    """``TEST value``."""

    start: int
    value: Expression
    cases: list[Case | Placeholder]
    end: int


# Declarations


@dataclass(slots=True)
class Data:
    """Variable, persistent or constant; ``scope`` is ``LOCAL``, ``TASK`` or empty."""

    start: int
    scope: str
    kind: str
    type: Name
    name: Name
    dimensions: list[Expression]
    value: Expression | None
    end: int


@dataclass(slots=True)
class Alias:
    """``ALIAS type name;``."""

    start: int
    scope: str
    type: Name
    name: Name
    end: int


@dataclass(slots=True)
class RecordComponent:
    """``type name;`` in a record."""

    type: Name
    name: Name


@dataclass(slots=True)
class Record:
    """``RECORD name``."""

    start: int
    scope: str
    name: Name
    components: list[RecordComponent]
    end: int


@dataclass(slots=True)
class Parameter:
    """Parameter of a routine.

    Attributes
    ----------
    mode
        ``VAR``, ``PERS``, ``INOUT``, or empty for a parameter by value.
    dimensions
        Number of dimensions of an array.
    """

    mode: str
    type: Name
    name: Name
    dimensions: int = 0


@dataclass(slots=True)
class ParameterGroup:
    """One required parameter, or optional ones of which at most one may be given."""

    is_optional: bool
    alternatives: list[Parameter | Placeholder]


@dataclass(slots=True)
class Handler:
    """``ERROR``, ``UNDO`` or ``BACKWARD`` of a routine, with the error numbers that it is for."""

    start: int
    kind: str
    numbers: list[Expression]
    body: list[Statement]


@dataclass(slots=True)
class Routine:
    """Procedure, function or trap: ``kind`` is ``PROC``, ``FUNC`` or ``TRAP``, ``type`` that of a function."""

    start: int
    scope: str
    kind: str
    type: Name | None
    name: Name
    groups: list[ParameterGroup]
    body: list[Statement]
    handlers: list[Handler]
    end: int

    def parameters(self) -> Iterator[Parameter]:
        """Yield all parameters, those that exclude each other too."""
        for group in self.groups:
            yield from (one for one in group.alternatives if isinstance(one, Parameter))


Statement: TypeAlias = (
    "Assignment | CallStatement | LateCall | Label | Goto | Return | Raise | Retry | TryNext | Exit | Connect | If "
    "| For | While | Test | Data | Placeholder"
)
Declaration: TypeAlias = "Data | Alias | Record | Routine | Placeholder"


@dataclass(slots=True)
class Module:
    """A module; ``attributes`` are upper case."""

    start: int
    name: Name
    attributes: list[str]
    items: list[Declaration]
    end: int


@dataclass(slots=True)
class Tree:
    """All of a file: its modules, or the statements of a fragment that stands in no module."""

    modules: list[Module] = field(default_factory=list)
    fragment: list[Statement] = field(default_factory=list)


def same(one: object, other: object) -> bool:
    """Return whether two trees mean the same, wherever their nodes stand and however names and numbers are spelled."""
    if isinstance(one, list):
        return isinstance(other, list) and len(one) == len(other) and all(map(same, one, other))
    if type(one) is not type(other):
        return False
    if isinstance(one, Literals):
        return isinstance(other, Literals) and "".join(one.text.split()) == "".join(other.text.split())
    if hasattr(one, "__dataclass_fields__"):
        places = {"start", "end", "at"}
        return all(same(getattr(one, f.name), getattr(other, f.name)) for f in fields(one) if f.name not in places)  # type: ignore[arg-type]
    return one == other


def children(node: object) -> Iterator[object]:
    """Yield the nodes and names directly in a node, in the order of the text as far as fields are."""
    if isinstance(node, Sequence) and not isinstance(node, str):
        yield from node
    elif hasattr(node, "__dataclass_fields__"):
        for one in fields(node):  # type: ignore[arg-type]
            value = getattr(node, one.name)
            if isinstance(value, list):
                yield from value
            elif isinstance(value, Name) or hasattr(value, "__dataclass_fields__"):
                yield value


def walk(node: object) -> Iterator[object]:
    """Yield a node and everything in it."""
    waiting = [node]
    while waiting:
        one = waiting.pop()
        yield one
        waiting.extend(reversed(list(children(one))))
