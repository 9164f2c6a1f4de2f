"""Operations of the language that Python has no operator for."""

from __future__ import annotations

import math
from typing import Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.poses import cross, quaternion_product
from daidalos.industry.rapid.runtime.values import checked_string


def integer_quotient(a: float, b: float) -> float:
    """Return the quotient of two whole numbers, cut to a whole number."""
    return float(math.trunc(a / b))


def remainder(a: float, b: float) -> float:
    """Return what is left of a division of whole numbers; it has the sign of the dividend."""
    if b == 0:
        raise ZeroDivisionError
    return math.fmod(a, b)


def vector_sum(a: list[float], b: list[float]) -> list[float]:
    """Return the sum of two positions."""
    return [a[0] + b[0], a[1] + b[1], a[2] + b[2]]


def vector_difference(a: list[float], b: list[float]) -> list[float]:
    """Return the difference of two positions."""
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]


def scaled(a: list[float], factor: float) -> list[float]:
    """Return a position times a number."""
    return [a[0] * factor, a[1] * factor, a[2] * factor]


def given(value: Any, name: str) -> Any:
    """Return the value of an optional argument.

    Raises
    ------
    RapidError
        ERR_NOTPRES, where there is none.
    """
    if value is None:
        raise RapidError("ERR_NOTPRES", f"the optional argument '{name}' is not present")
    return value


def referred(reference: tuple[Any, Any]) -> Any:
    """Return the value that a reference is of."""
    return reference[0][reference[1]]


OPERATIONS = {
    "_div": integer_quotient,
    "_mod": remainder,
    "_vector_sum": vector_sum,
    "_vector_difference": vector_difference,
    "_scaled": scaled,
    "_cross": cross,
    "_quaternion_product": quaternion_product,
    "_text": checked_string,
    "_given": given,
    "_referred": referred,
}
