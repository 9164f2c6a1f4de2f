"""Typed values that may still be text: coercion by YAML's rules, and substitutions with a type.

The types are `int`, `float`, `bool`, `str` and uniform lists of these.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import (  # noqa: UP035 - callers pass typing.List
    TYPE_CHECKING,
    Any,
    List,
    TypeGuard,
    TypeVar,
    Union,
    get_args,
    get_origin,
    overload,
)

from daidalos.common.documents import DocumentError, parse_yaml

from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from .ensure_argument_type_impl import ensure_argument_type
from .normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from .perform_substitutions_impl import perform_substitutions

if TYPE_CHECKING:
    from ..launch_context import LaunchContext

__all__ = [
    "AllowedTypesTuple",
    "AllowedTypesType",
    "AllowedValueType",
    "ListType",
    "ListTypesTuple",
    "ListValueType",
    "NormalizedValueType",
    "ScalarType",
    "ScalarTypesTuple",
    "ScalarValueType",
    "SomeValueType",
    "coerce_list",
    "coerce_to_type",
    "ensure_argument_type",
    "extract_type",
    "get_typed_value",
    "is_instance_of",
    "is_instance_of_valid_type",
    "is_normalized_substitution",
    "is_substitution",
    "is_typing_list",
    "is_valid_scalar_type",
    "normalize_typed_substitution",
    "perform_typed_substitution",
]

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (List[int], List[float], List[bool], List[str])  # noqa: UP006 - compared with what callers pass
AllowedTypesTuple = (*ScalarTypesTuple, *ListTypesTuple)

ScalarType = type[int] | type[float] | type[bool] | type[str]
ListType = Union[type[list[int]], type[list[float]], type[list[bool]], type[list[str]]]  # noqa: UP007
AllowedTypesType = Union[ScalarType, ListType]  # noqa: UP007

ScalarValueType = int | float | bool | str
Scalar = TypeVar("Scalar", bound=ScalarValueType)
ListValueType = Sequence[int] | Sequence[float] | Sequence[bool] | Sequence[str]
AllowedValueType = ScalarValueType | ListValueType
NormalizedScalarType = ScalarValueType | list[Substitution]
NormalizedValueType = NormalizedScalarType | list[NormalizedScalarType]
SomeValueType = SomeSubstitutionsType | AllowedValueType | NormalizedValueType


# Types --------------------------------------------------------------------------------------------


def is_typing_list(data_type: Any) -> bool:
    """Return whether a type is `typing.List`, with or without the type of its items."""
    return data_type is List or get_origin(data_type) is list  # noqa: UP006 - see above


def is_valid_scalar_type(data_type: Any) -> TypeGuard[ScalarType]:
    """Return whether a type is one of the scalar types."""
    return data_type in ScalarTypesTuple


def extract_type(data_type: AllowedTypesType) -> tuple[ScalarType, bool]:
    """Return a type's scalar type and whether it is a list of these.

    Raises
    ------
    ValueError
        If it is neither a scalar type nor a list type.
    """
    items = get_args(data_type) if is_typing_list(data_type) else ()
    if items and is_valid_scalar_type(items[0]):
        return items[0], True
    if is_valid_scalar_type(data_type):
        return data_type, False
    raise ValueError(f"unrecognized data type: {data_type}")


def is_instance_of_valid_type(value: Any, *, can_be_str: bool = False) -> bool:
    """Return whether a value is a scalar or a uniform list; with `can_be_str` strings may be in any list."""
    if not isinstance(value, list):
        return any(_is_scalar(value, scalar) for scalar in ScalarTypesTuple)
    return any(_is_list(value, scalar, can_be_str) for scalar in ScalarTypesTuple)


def is_instance_of(value: Any, data_type: AllowedTypesType | None = None, *, can_be_str: bool = False) -> bool:
    """Return whether a value is of a type (None: of any); with `can_be_str` a string may stand for a scalar."""
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    scalar, is_list = extract_type(data_type)
    if is_list:
        return isinstance(value, list) and _is_list(value, scalar, can_be_str)
    return _is_scalar(value, scalar) or (can_be_str and isinstance(value, str))


def _is_scalar(value: Any, scalar: ScalarType) -> bool:
    # Python counts bool as int; a launch file that says `true` does not mean 1.
    return isinstance(value, scalar) and (scalar is not int or not isinstance(value, bool))


def _is_list(values: list[Any], scalar: ScalarType, can_be_str: bool) -> bool:
    return all(_is_scalar(value, scalar) or (can_be_str and isinstance(value, str)) for value in values)


# Coercion -----------------------------------------------------------------------------------------


def coerce_to_type(value: str, data_type: AllowedTypesType | None = None, *, can_be_str: bool = False) -> Any:
    """Convert text to a type by the rules of YAML.

    Parameters
    ----------
    value
        The text.
    data_type
        The type, or None for whatever the text looks like.
    can_be_str
        Return the text as it is when it cannot be converted, and accept strings among the items of a list.

    Raises
    ------
    TypeError
        If `value` is not a string.
    ValueError
        If it cannot be converted.
    """
    ensure_argument_type(value, str, "value", "coerce_to_type")
    if data_type is str:
        return value
    if data_type is not None:
        extract_type(data_type)
    try:
        return _coerce(value, data_type, can_be_str)
    except ValueError:
        if can_be_str:
            return value
        raise


def _coerce(value: str, data_type: AllowedTypesType | None, can_be_str: bool) -> Any:
    if data_type is None and not value:
        return value
    if data_type is bool and value.strip() in ("0", "1"):
        return value.strip() == "1"
    output = _load_yaml(value, data_type)
    if data_type is float:
        output = _as_float(output)
    if not is_instance_of(output, data_type, can_be_str=can_be_str and isinstance(output, list)):
        wanted = "one of the types of launch" if data_type is None else _name(data_type)
        raise ValueError(f"failed to convert '{value}' to {wanted} using YAML's rules")
    return output


def _as_float(value: Any) -> Any:
    """Return a float for what stands for one; YAML takes 1e-3 for a text, because it has no point."""
    if _is_scalar(value, int):
        return float(value)
    if isinstance(value, str):
        with contextlib.suppress(ValueError):
            return float(value)
    return value


def _load_yaml(value: str, data_type: AllowedTypesType | None) -> Any:
    try:
        return parse_yaml(value)
    except DocumentError as error:
        problem = f"it is not YAML: {error.described}"
        raise ValueError(f"failed to convert '{value}' to {_name(data_type)}: {problem}") from error


def _name(data_type: AllowedTypesType | None) -> str:
    return getattr(data_type, "__name__", str(data_type)) if not is_typing_list(data_type) else str(data_type)


def coerce_list(value: Iterable[str], data_type: ScalarType | None = None, *, can_be_str: bool = False) -> list[Any]:
    """Convert texts to a uniform list of a scalar type.

    Parameters
    ----------
    value
        The texts.
    data_type
        The type of the items, or None for whatever they all look like.
    can_be_str
        Leave a text that cannot be converted as it is.

    Raises
    ------
    TypeError
        If `value` is not a list of strings.
    ValueError
        If one cannot be converted, or if they do not look alike.
    """
    ensure_argument_type(value, list, "value", "coerce_list")
    items = [coerce_to_type(item, data_type, can_be_str=can_be_str) for item in value]
    if data_type is not None or is_instance_of(items, None, can_be_str=can_be_str):
        return items
    raise ValueError(f"the items of {list(value)} are not of one type")


def get_typed_value(value: str | list[str], data_type: AllowedTypesType | None, *, can_be_str: bool = False) -> Any:
    """Convert text, or a list of texts, to a type.

    Raises
    ------
    TypeError
        If `value` is neither of these, or if it is a list and `data_type` is a scalar type.
    ValueError
        If it cannot be converted.
    """
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    scalar = None
    if data_type is not None:
        scalar, is_list = extract_type(data_type)
        if not is_list:
            raise TypeError(f"{value} is a list, but {_name(data_type)} is expected")
    return coerce_list(value, scalar, can_be_str=can_be_str)


# Substitutions with a type ------------------------------------------------------------------------


def is_substitution(x: Any) -> TypeGuard[Substitution | list[str | Path | Substitution]]:
    """Return whether a value is a substitution, or substitutions and strings in a row."""
    if isinstance(x, Substitution):
        return True
    if isinstance(x, str) or not isinstance(x, Iterable):
        return False
    items = list(x)
    return any(isinstance(item, Substitution) for item in items) and all(
        isinstance(item, str | Path | Substitution) for item in items
    )


def is_normalized_substitution(x: Any) -> TypeGuard[list[Substitution]]:
    """Return whether a value is a non-empty list of substitutions."""
    return isinstance(x, list) and len(x) > 0 and all(isinstance(item, Substitution) for item in x)


def normalize_typed_substitution(value: SomeValueType, data_type: AllowedTypesType | None) -> NormalizedValueType:
    """Convert a value that may hold substitutions to the form that `perform_typed_substitution` takes.

    Scalars and strings stay what they are. Substitutions, and strings and substitutions in a row, become a
    list of substitutions, whose text is converted when they are performed. Any other list becomes a list of
    these two.

    Parameters
    ----------
    value
        A scalar, a substitution, substitutions and strings in a row, or a list of these.
    data_type
        What it is to be in the end, or None for any type.

    Raises
    ------
    TypeError
        If the value cannot become that.
    """
    scalar, is_list = (None, False) if data_type is None else extract_type(data_type)
    if isinstance(value, Path):
        value = str(value)
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if isinstance(value, ScalarTypesTuple):
        if is_list:
            raise TypeError(f"expected {_name(data_type)}, but got {value!r}")
        return _checked_scalar(value, scalar)
    if isinstance(value, Mapping | bytes) or not isinstance(value, Iterable):
        raise TypeError(f"a value with a type is a scalar, a substitution or a list, not {value!r}")
    if scalar is not None and not is_list:
        raise TypeError(f"expected {_name(data_type)}, but got the list {value!r}")
    return _normalized_list(list(value), scalar)


def _checked_scalar(value: Any, scalar: ScalarType | None) -> ScalarValueType:
    if scalar is float and _is_scalar(value, int):
        return float(value)
    if not is_instance_of(value, scalar):
        wanted = "a scalar or a text" if scalar is None else scalar.__name__
        raise TypeError(f"expected {wanted}, but got {value!r} of type {type(value).__name__}")
    checked: ScalarValueType = value
    return checked


def _normalized_list(items: list[Any], scalar: ScalarType | None) -> list[NormalizedScalarType]:
    normalized = [
        normalize_to_list_of_substitutions(item) if is_substitution(item) else _checked_scalar(item, scalar)
        for item in items
    ]
    plain = [item for item in normalized if not isinstance(item, list)]
    if {type(item) for item in plain} == {int, float}:
        normalized = [item if isinstance(item, list) else _checked_scalar(item, float) for item in normalized]
    elif not is_instance_of_valid_type(plain):
        raise TypeError(f"the items of {items!r} are not of one type")
    return normalized


@overload
def perform_typed_substitution(
    context: LaunchContext, value: NormalizedValueType, data_type: type[Scalar]
) -> Scalar: ...
@overload
def perform_typed_substitution(
    context: LaunchContext, value: NormalizedValueType, data_type: AllowedTypesType | None
) -> AllowedValueType: ...
def perform_typed_substitution(context: LaunchContext, value: NormalizedValueType, data_type: Any) -> Any:
    """Evaluate a value that `normalize_typed_substitution` prepared.

    Raises
    ------
    ValueError
        If the text cannot be converted to the type.
    TypeError
        If the value is of another type.
    """
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    scalar = None if data_type is None else extract_type(data_type)[0]
    if not isinstance(value, list):
        return _checked_scalar(value, scalar)
    performed = [
        coerce_to_type(perform_substitutions(context, item), scalar)
        if isinstance(item, list)
        else _checked_scalar(item, scalar)
        for item in value
    ]
    if not is_instance_of(performed, data_type):
        wanted = "a list of one type" if data_type is None else str(data_type)
        raise ValueError(f"expected {wanted}, but got {performed!r}")
    return performed
