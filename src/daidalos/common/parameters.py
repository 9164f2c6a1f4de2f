"""Parameters declared once, as frozen dataclasses: names, types, units, ranges and what each one does.

A class derives from `Parameters` and makes its fields with `parameter`, `group` and `per_name`. From this declaration
come the checks whenever an instance is made, `parameters_from` for mappings such as files, `replace` for changes at run
time, `leaves` for whoever offers the parameters elsewhere (a ROS node, an editor), and `table` for the manual.
"""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from daidalos.common.errors import Location, UserError
from daidalos.common.suggestions import near

T = TypeVar("T", bound="Parameters")
_TYPE_NAMES = {bool: "a boolean", int: "an integer", float: "a float", str: "a string"}


class ParameterError(UserError, ValueError):
    """Invalid value of a parameter.

    Parameters
    ----------
    name : str
        The parameter, with dots.
    problem : str
        Continues "parameter 'name' ...", such as ``must be above 0, got -1``.
    location : Location or None
        Where the value was given.
    """

    def __init__(self, name: str, problem: str, location: Location | None = None) -> None:
        super().__init__(f"parameter '{name}' {problem}", location)
        self.name = name
        self.problem = problem


@dataclass(frozen=True)
class Constraints:
    """Constraints of a parameter beside its name and type; see `parameter`."""

    description: str
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    above: float | None = None
    below: float | None = None
    choices: tuple[Any, ...] = ()
    length: int | None = None
    not_empty: bool = False
    unique: bool = False
    read_only: bool = False
    takes_integer: bool = False

    @property
    def is_bounded(self) -> bool:
        """Whether there is a lower or an upper bound."""
        return any(one is not None for one in (self.minimum, self.maximum, self.above, self.below))

    @property
    def text(self) -> str:
        """The constraints in words, such as ``above 0, at most 1``; empty where there are none."""
        bounds = (("at least", self.minimum), ("above", self.above), ("at most", self.maximum), ("below", self.below))
        words = [f"{word} {bound:g}" for word, bound in bounds if bound is not None]
        if self.choices:
            words.append(f"one of {', '.join(str(one) for one in self.choices)}")
        if self.length is not None:
            words.append(f"{self.length} elements")
        words += [word for word, holds in (("not empty", self.not_empty), ("no duplicates", self.unique)) if holds]
        return ", ".join(words)


@dataclass(frozen=True)
class Leaf:
    """Single parameter of a parameter class.

    Parameters
    ----------
    name : str
        With dots.
    default : object
    type : type
        Of the value, or of its elements: bool, int, float or str.
    is_array : bool
        Whether the value is a tuple.
    constraints : Constraints
    """

    name: str
    default: Any
    type: type
    is_array: bool
    constraints: Constraints

    @property
    def type_name(self) -> str:
        """The type in words, such as ``a float`` or ``a list of strings``."""
        name = _TYPE_NAMES[self.type]
        return f"a list of {name.split()[-1]}s" if self.is_array else name

    def typed(self, value: Any, integers: bool = True) -> Any:
        """Return a value in the parameter's type.

        Parameters
        ----------
        value : object
            Such as a file has it.
        integers : bool
            Whether an integer may stand for a float; otherwise only where the declaration says ``takes_integer``.

        Raises
        ------
        ParameterError
            When it is of another type.
        """
        integers = integers or self.constraints.takes_integer
        if not self.is_array:
            return self._scalar(value, value, integers)
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise ParameterError(self.name, f"must be {self.type_name}, got {value!r}")
        return tuple(self._scalar(one, value, integers) for one in value)

    def _scalar(self, value: Any, given: Any, integers: bool) -> Any:
        if type(value) is self.type:
            return value
        is_integer = self.type is float and type(value) is int
        if is_integer and abs(value) > sys.float_info.max:
            raise ParameterError(self.name, f"must be {self.type_name}, got an integer that is too large")
        if is_integer and integers:
            return float(value)
        hint = f", an integer; write {float(value)}" if is_integer else ""
        raise ParameterError(self.name, f"must be {self.type_name}, got {given!r}{hint}")

    def check(self, value: Any) -> None:
        """Refuse a value of the right type that the constraints do not allow.

        Raises
        ------
        ParameterError
            Saying what is expected.
        """
        constraints = self.constraints
        if constraints.not_empty and not len(value):
            raise ParameterError(self.name, "must not be empty")
        if constraints.length is not None and len(value) != constraints.length:
            raise ParameterError(self.name, f"must have {constraints.length} elements, got {len(value)}")
        if constraints.unique and len(set(value)) != len(value):
            raise ParameterError(self.name, f"has duplicates: {list(value)}")
        if constraints.choices or constraints.is_bounded:
            for one in value if self.is_array else (value,):
                self._check_one(one)

    def _check_one(self, value: Any) -> None:
        constraints = self.constraints
        if constraints.choices and value not in constraints.choices:
            allowed = ", ".join(str(one) for one in constraints.choices)
            words = "may have" if self.is_array else "must be one of"
            raise ParameterError(self.name, f"{words} {allowed}, got {value!r}")
        if not constraints.is_bounded:
            return
        is_nan = math.isnan(value)
        for words, bound, holds in (
            ("at least", constraints.minimum, operator.ge),
            ("above", constraints.above, operator.gt),
            ("at most", constraints.maximum, operator.le),
            ("below", constraints.below, operator.lt),
        ):
            if bound is not None and not holds(value, bound) and not (is_nan and self._is_nan_allowed):
                raise ParameterError(self.name, f"must be {words} {bound:g}, got {value:g}")

    @property
    def _is_nan_allowed(self) -> bool:
        """Return whether NaN stands for "none", as it does where it is the default."""
        return isinstance(self.default, float) and math.isnan(self.default)


class Parameters:
    """Base of parameter classes, which are frozen dataclasses; a method `check` may look at values together.

    Raises
    ------
    ParameterError
        When an instance is made with a value that is not allowed.
    """

    def __post_init__(self) -> None:
        for entry in _entries(type(self)):
            if entry.leaf is not None:
                entry.leaf.check(getattr(self, entry.field))
            elif entry.by and not getattr(self, entry.field):
                object.__setattr__(self, entry.field, {name: entry.kind() for name in _names(getattr(self, entry.by))})
        self.check()

    def check(self) -> None:
        """Refuse values that do not fit together by raising `ParameterError`."""


def parameter(
    default: Any,
    description: str,
    *,
    unit: str = "",
    minimum: float | None = None,
    maximum: float | None = None,
    above: float | None = None,
    below: float | None = None,
    choices: Iterable[Any] = (),
    length: int | None = None,
    not_empty: bool = False,
    unique: bool = False,
    name: str | None = None,
    read_only: bool = False,
    takes_integer: bool = False,
) -> Any:
    """Return the dataclass field of a parameter: a bool, int, float, str, or a tuple of one of these.

    Parameters
    ----------
    default : object
        NaN stands for "none" and is allowed whatever the bounds are.
    description : str
        What it does, in one sentence.
    unit : str
        Of a physical quantity, such as ``m/s``.
    minimum, maximum : float or None
        Bounds of a number, or of each element.
    above, below : float or None
        Bounds that are not allowed themselves.
    choices : iterable
        Allowed values, or allowed elements of a tuple.
    length : int or None
        Of a tuple.
    not_empty, unique : bool
        For strings and tuples, and for tuples.
    name : str or None
        In ROS, where the field cannot have that name; empty for the only parameter of a group, which is called as
        the group.
    read_only : bool
        Whether it stays as it is while its owner runs.
    takes_integer : bool
        Whether files may give an integer for this float; ROS 2 refuses that elsewhere.
    """
    constraints = Constraints(
        description, unit, minimum, maximum, above, below, tuple(choices), length, not_empty, unique, read_only,
        takes_integer,
    )  # fmt: skip
    return field(default=default, metadata={"constraints": constraints, "name": name})


def group(kind: type[Parameters], name: str | None = None) -> Any:
    """Return the dataclass field of a group of parameters, called ``<field>.<parameter>``.

    Parameters
    ----------
    kind : type
    name : str or None
        In ROS, where the field cannot have that name.
    """
    return field(default_factory=kind, metadata={"group": kind, "name": name})


def per_name(kind: type[Parameters], by: str, at: str | None = None) -> Any:
    """Return the dataclass field of a mapping that has a group of parameters for each of some names.

    Parameters
    ----------
    kind : type
        Of the groups.
    by : str
        The field with the names: a tuple, or a string with spaces between them.
    at : str or None
        The parameters are called ``<at>.<name>.<parameter>``; `at` is the field where None, and left out where empty.
    """
    return field(default_factory=dict, metadata={"group": kind, "by": by, "name": at})


def build(kind: type[T], get: Callable[[Leaf], Any]) -> T:
    """Make a parameter class.

    Parameters
    ----------
    kind : type
    get : callable
        Returns the value of a parameter.

    Raises
    ------
    ParameterError
        When a value is not allowed.
    """
    return _build(kind, get, "")


def parameters_from(kind: type[T], values: Mapping[str, Any]) -> T:
    """Make a parameter class from nested mappings, as ``yaml`` reads them, or from names with dots.

    Raises
    ------
    ParameterError
        When a value is of the wrong type or not allowed, or no parameter has a name.
    """
    left = dict(_flatten(values, ""))
    result = build(kind, lambda leaf: leaf.typed(left.pop(leaf.name)) if leaf.name in left else leaf.default)
    _refuse_rest(left, [leaf.name for leaf in leaves(kind)])
    return result


def replace(parameters: T, changes: Mapping[str, Any]) -> T:
    """Return parameters with other values.

    Parameters
    ----------
    parameters : Parameters
    changes : mapping
        Values by name, with dots.

    Raises
    ------
    ParameterError
        When a value is of the wrong type or not allowed, a parameter is read-only, or no parameter has a name.
    """
    left = dict(changes)
    before = values_of(parameters)

    def get(leaf: Leaf) -> Any:
        old = before.get(leaf.name, leaf.default)
        if leaf.name not in left:
            return old
        new = leaf.typed(left.pop(leaf.name))
        if leaf.constraints.read_only and new != old:
            raise ParameterError(leaf.name, "is read-only")
        return new

    result = build(type(parameters), get)
    _refuse_rest(left, before)
    return result


def values_of(parameters: Parameters) -> dict[str, Any]:
    """Return all values by name, with dots."""
    found: dict[str, Any] = {}
    for entry in _entries(type(parameters)):
        value = getattr(parameters, entry.field)
        if entry.leaf is not None:
            found[entry.name] = value
            continue
        groups = [("", value)] if not entry.by else [(f"{name}.", one) for name, one in value.items()]
        for prefix, one in groups:
            found |= {_joined(f"{entry.prefix}{prefix}", name): inner for name, inner in values_of(one).items()}
    return found


def leaves(kind: type[Parameters], prefix: str = "") -> Iterator[Leaf]:
    """Yield all parameters of a class; those of groups by name have ``<field with the names>`` in their names."""
    for entry in _entries(kind):
        if entry.leaf is not None:
            yield _named(entry.leaf, prefix)
        else:
            by = f"<{entry.by}>." if entry.by else ""
            yield from leaves(entry.kind, f"{prefix}{entry.prefix}{by}")


def group_kinds(kind: type[Parameters]) -> Iterator[type[Parameters]]:
    """Yield the classes of a class's groups, and of theirs."""
    for entry in _entries(kind):
        if entry.kind is not None:
            yield entry.kind
            yield from group_kinds(entry.kind)


def table(kind: type[Parameters]) -> str:
    """Return a Markdown table of all parameters."""
    lines = ["| Parameter | Type | Default | Unit | Allowed | What it does |", "|---|---|---|---|---|---|"]
    for leaf in leaves(kind):
        default = list(leaf.default) if leaf.is_array else leaf.default
        type_name = leaf.type_name.removeprefix("a ").removeprefix("an ")
        allowed = ", ".join(word for word in (leaf.constraints.text, "read-only" * leaf.constraints.read_only) if word)
        cells = (
            f"`{leaf.name}`", type_name, f"`{default!r}`", leaf.constraints.unit, allowed, leaf.constraints.description
        )  # fmt: skip
        lines.append(f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |")
    return "\n".join(lines) + "\n"


# Reading the declaration.


@dataclass(frozen=True)
class _Entry:
    """Field of a parameter class: a parameter, a group, or groups by the names in the field `by`."""

    field: str
    name: str
    leaf: Leaf | None = None
    kind: Any = None
    by: str = ""

    @property
    def prefix(self) -> str:
        """Prefix of the names of a group's parameters."""
        return f"{self.name}." if self.name else ""


_entries_of: dict[type, tuple[_Entry, ...]] = {}


def _entries(kind: type[Parameters]) -> tuple[_Entry, ...]:
    """Return the fields; groups by name come last, since they need the names."""
    if kind not in _entries_of:
        hints = get_type_hints(kind)
        entries = [_entry(one, hints[one.name]) for one in fields(kind)]  # type: ignore[arg-type]
        _entries_of[kind] = tuple(sorted(entries, key=lambda entry: bool(entry.by)))
    return _entries_of[kind]


def _entry(one: Field[Any], hint: Any) -> _Entry:
    name = one.metadata.get("name")
    name = one.name if name is None else name
    if "group" in one.metadata:
        return _Entry(one.name, name, kind=one.metadata["group"], by=one.metadata.get("by", ""))
    constraints = one.metadata.get("constraints")
    assert constraints is not None, f"make the field '{one.name}' with parameter()"
    is_array = get_origin(hint) is tuple
    kind = get_args(hint)[0] if is_array else hint
    return _Entry(one.name, name, Leaf(name, one.default, kind, is_array, constraints))


def _named(leaf: Leaf, prefix: str) -> Leaf:
    name = _joined(prefix, leaf.name)
    return Leaf(name, leaf.default, leaf.type, leaf.is_array, leaf.constraints) if prefix else leaf


def _joined(prefix: str, name: str) -> str:
    """Return a name below a prefix that ends in a dot; a parameter without a name is called as its group."""
    return f"{prefix}{name}" if name else prefix.removesuffix(".")


def _build(kind: type[T], get: Callable[[Leaf], Any], prefix: str) -> T:
    values: dict[str, Any] = {}
    for entry in _entries(kind):
        if entry.leaf is not None:
            value = get(_named(entry.leaf, prefix))
            values[entry.field] = tuple(value) if entry.leaf.is_array else value
            continue
        below = f"{prefix}{entry.prefix}"
        if not entry.by:
            values[entry.field] = _build(entry.kind, get, below)
            continue
        names = _names(values[entry.by])
        values[entry.field] = {one: _build(entry.kind, get, f"{below}{one}.") for one in names}
    try:
        return kind(**values)
    except ParameterError as error:
        raise ParameterError(f"{prefix}{error.name}", error.problem) from None


def _names(value: str | Sequence[str]) -> dict[str, None]:
    """Return the names in a field, once each and in order."""
    return dict.fromkeys(value.split() if isinstance(value, str) else value)


def _flatten(values: Mapping[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _refuse_rest(left: Mapping[str, Any], known: Iterable[str]) -> None:
    for name in left:
        found = near(name, known)
        raise ParameterError(name, f"is not declared{f'; did you mean {found[0]!r}?' if found else ''}")
