"""The types that attributes of launch file elements may have."""

from __future__ import annotations

from typing import Any, List, get_args, get_origin  # noqa: UP035 - what callers pass

from ..utilities.type_utils import AllowedTypesType
from .entity import Entity


def check_is_list_entity(data_type: Any) -> bool:
    """Return whether a type is a list of elements."""
    return get_origin(data_type) is list and get_args(data_type)[0] is Entity


def get_data_type_from_identifier(type_identifier: str) -> AllowedTypesType:
    """Return the type that a launch file means by a word: `int`, `list_of_int` and so on.

    Raises
    ------
    ValueError
        If it is no such word.
    """
    types: dict[str, AllowedTypesType] = {
        "str": str,
        "int": int,
        "float": float,
        "bool": bool,
        "list_of_str": List[str],  # noqa: UP006
        "list_of_int": List[int],  # noqa: UP006
        "list_of_float": List[float],  # noqa: UP006
        "list_of_bool": List[bool],  # noqa: UP006
    }
    if type_identifier not in types:
        raise ValueError(f"unknown type '{type_identifier}', expected one of {', '.join(types)}")
    return types[type_identifier]
