"""A check of an argument's type with a helpful message."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .class_tools_impl import is_a_subclass


def ensure_argument_type(
    argument: Any, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """Check that an argument is of one of some types.

    Parameters
    ----------
    argument
        The value to check.
    types
        The type, or the types of which it may be.
    argument_name
        How the message calls it.
    caller
        Whose argument it is, for the message.

    Raises
    ------
    TypeError
        If it is of none of them, or if `types` holds something that is not a type.
    """
    accepted = (types,) if isinstance(types, type) else tuple(types)
    for entry in accepted:
        if not isinstance(entry, type):
            raise TypeError(f"'types' must be a type or several, but it has {entry!r} in it")
    if any(is_a_subclass(argument, entry) for entry in accepted):
        return
    where = f" of {caller}" if caller else ""
    names = " or ".join(entry.__name__ for entry in accepted)
    raise TypeError(
        f"argument '{argument_name}'{where} is expected to be {names}, "
        f"but it is {argument!r} of type {type(argument).__name__}"
    )
