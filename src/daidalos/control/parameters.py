"""Parameters of controllers as dataclasses: nested groups, groups for each joint, and what values may be.

A shell reads them from wherever it keeps them with `read_parameters`: a node from its parameters, a test or a
notebook from a dictionary with `parameters_from`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from daidalos.control.errors import ParameterError

T = TypeVar("T")
Check = Callable[[Any], str]
"""Returns what is wrong with a value, nothing where it is right."""


@dataclass(frozen=True)
class Leaf:
    """One parameter.

    Parameters
    ----------
    name : str
        With dots.
    default : object
    type : type
        Of the value, or of its elements: bool, int, float or str.
    many : bool
        Whether the value is a tuple.
    read_only : bool
        Whether it stays as it is once the controller is there.
    """

    name: str
    default: Any
    type: type
    many: bool
    read_only: bool


def parameter(default: Any, *checks: Check, read_only: bool = False) -> Any:
    """Return the dataclass field of a parameter; lists are tuples."""
    return field(default=default, metadata={"checks": checks, "read_only": read_only})


def per_name(kind: type, by: str, at: str | None = None) -> dict[str, Any]:
    """Return the metadata of a field, a mapping, that has a group for each name in the parameter `by` (one or a list).

    Its parameters are called ``<at>.<name>.<parameter>``; `at` is the field where None.
    """
    return {"kind": kind, "by": by, "at": at}


def read_parameters(kind: type[T], get: Callable[[Leaf], Any]) -> T:
    """Make a parameter class.

    Parameters
    ----------
    kind : type
        A dataclass of fields made by `parameter`; of groups, which are fields whose ``default_factory`` is such
        a dataclass; and of mappings, whose ``metadata`` is from `per_name`. Where it has a method `check`,
        that is called at the end to look at values together.
    get : callable
        Returns the value for a parameter.

    Raises
    ------
    ParameterError
        When a value is not allowed.
    """
    result = _read(kind, get, "")
    check = getattr(result, "check", None)
    if check is not None:
        check()
    return result


def parameters_from(kind: type[T], values: Mapping[str, Any]) -> T:
    """Make a parameter class from nested dictionaries, as ``yaml`` reads them.

    Raises
    ------
    ParameterError
        When a value is of the wrong type or not allowed, or nothing is called so.
    """
    left = dict(_flatten(values, ""))

    def get(leaf: Leaf) -> Any:
        return _checked_type(leaf, left.pop(leaf.name)) if leaf.name in left else leaf.default

    result = read_parameters(kind, get)
    for name in left:
        raise ParameterError(name, "is not known")
    return result


def _read(kind: type[T], get: Callable[[Leaf], Any], prefix: str) -> T:
    values: dict[str, Any] = {}
    hints = get_type_hints(kind)
    for entry in fields(kind):  # type: ignore[arg-type]
        if "by" in entry.metadata:
            continue
        name = f"{prefix}{entry.name}"
        nested = entry.default_factory
        if isinstance(nested, type) and is_dataclass(nested):
            values[entry.name] = _read(nested, get, f"{name}.")
        else:
            values[entry.name] = _leaf(entry, hints[entry.name], name, get)
    for entry in fields(kind):  # type: ignore[arg-type]
        if "by" in entry.metadata:
            group_kind, by, at = (entry.metadata[key] for key in ("kind", "by", "at"))
            place = f"{prefix}{at or entry.name}"
            names = (values[by],) if isinstance(values[by], str) else values[by]
            values[entry.name] = {one: _read(group_kind, get, f"{place}.{one}.") for one in dict.fromkeys(names)}
    return kind(**values)


def _leaf(entry: Field[Any], hint: Any, name: str, get: Callable[[Leaf], Any]) -> Any:
    assert entry.default is not MISSING, f"{name} needs a default"
    many = get_origin(hint) is tuple
    kind = get_args(hint)[0] if many else hint
    value = get(Leaf(name, entry.default, kind, many, entry.metadata["read_only"]))
    if many:
        value = tuple(value)
    for check in entry.metadata["checks"]:
        problem = check(value)
        if problem:
            raise ParameterError(name, problem)
    return value


def _flatten(values: Mapping[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _checked_type(leaf: Leaf, value: Any) -> Any:
    """Return a value in the parameter's type; a whole number may stand for a float."""
    if leaf.many:
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise ParameterError(leaf.name, f"should be a list of {leaf.type.__name__}, got {value!r}")
        return tuple(_checked_scalar(leaf, one) for one in value)
    return _checked_scalar(leaf, value)


def _checked_scalar(leaf: Leaf, value: Any) -> Any:
    if leaf.type is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if type(value) is not leaf.type:
        raise ParameterError(leaf.name, f"should be of type {leaf.type.__name__}, got {value!r}")
    return value


# What values may be.


def not_empty(value: Any) -> str:
    """Refuse empty strings and lists."""
    return "" if len(value) else "must not be empty"


def unique(value: Sequence[Any]) -> str:
    """Refuse a list that has something twice."""
    return "" if len(set(value)) == len(value) else f"has something twice: {list(value)}"


def above(limit: float) -> Check:
    """Refuse numbers up to a limit."""
    return lambda value: "" if value > limit else f"must be above {limit:g}, got {value:g}"


def at_least(limit: float) -> Check:
    """Refuse numbers below a limit."""
    return lambda value: "" if value >= limit else f"must be at least {limit:g}, got {value:g}"


def size(count: int) -> Check:
    """Refuse lists of another length."""
    return lambda value: "" if len(value) == count else f"must have {count} elements, got {len(value)}"


def elements_within(lower: float, upper: float) -> Check:
    """Refuse lists with numbers outside bounds."""

    def check(value: Sequence[float]) -> str:
        outside = [one for one in value if not lower <= one <= upper]
        return f"must have elements from {lower:g} to {upper:g}, got {outside[0]:g}" if outside else ""

    return check


def one_of(*choices: str) -> Check:
    """Refuse what is not among the choices."""
    return lambda value: "" if value in choices else f"must be one of {', '.join(choices)}, got {value!r}"


def subset_of(*choices: str) -> Check:
    """Refuse lists with an element that is not among the choices."""

    def check(value: Sequence[str]) -> str:
        strange = [one for one in value if one not in choices]
        return f"may have {', '.join(choices)}, got {strange[0]!r}" if strange else ""

    return check
