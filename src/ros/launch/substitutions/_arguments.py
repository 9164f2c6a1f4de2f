"""Checks and descriptions that the substitutions share."""

from __future__ import annotations

from collections.abc import Iterable, Sized

from ..substitution import Substitution


def expect_arguments(name: str, data: Sized, minimum: int, maximum: int | None = None) -> None:
    """Check how many arguments `$(name ...)` was given.

    Raises
    ------
    TypeError
        If there are too few or too many.
    """
    maximum = minimum if maximum is None else maximum
    if not minimum <= len(data) <= maximum:
        wanted = str(minimum) if minimum == maximum else f"{minimum} to {maximum}"
        plural = "" if maximum == 1 else "s"
        raise TypeError(f"$({name} ...) takes {wanted} argument{plural}, but it was given {len(data)}")


def describe_text(substitutions: Iterable[Substitution]) -> str:
    """Return substitutions in a row in words."""
    return " + ".join(substitution.describe() for substitution in substitutions)
