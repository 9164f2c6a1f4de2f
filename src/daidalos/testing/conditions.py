"""Conditions that assertions put on values: a function, a value with a tolerance, limits, or the fields of a value."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint

_ANGLES = ("roll", "pitch", "yaw")
_UNSET = object()


@dataclass(frozen=True)
class Condition:
    """Condition on a value.

    Parameters
    ----------
    text : str
        What it requires, such as ``above 0.5``.
    holds : callable
        Returns whether a value fulfils it.
    miss : callable, optional
        Returns how far a value is from fulfilling it, for the nearest of those that did not.
    """

    text: str
    holds: Callable[[Any], bool]
    miss: Callable[[Any], float] | None = None


def condition(
    test: Any = None,
    *,
    equals: Any = _UNSET,
    tolerance: float = 0.0,
    yaw_tolerance: float | None = None,
    above: float | None = None,
    below: float | None = None,
    between: tuple[float, float] | None = None,
    **fields: Any,
) -> Condition:
    """Return a condition; all parts that are given have to hold.

    Parameters
    ----------
    test : callable or value, optional
        A function of the value that returns whether it holds, or a value that it has to be equal to, such as
        ``pytest.approx(1.5, abs=0.1)``.
    equals : optional
        A value that it has to be equal to, numbers within `tolerance`.
    tolerance : float
        Largest difference of numbers from `equals` and from `fields`.
    yaw_tolerance : float, optional
        The same for angles [rad]; `tolerance` where None.
    above, below : float, optional
        Limits that it must be beyond.
    between : tuple of 2 floats, optional
        Limits that it has to stay within, themselves included.
    **fields
        Values of its attributes, such as ``x=1.5``; angles are compared within one turn.

    Raises
    ------
    UserError
        When nothing is required.
    """
    parts: list[Condition] = []
    if callable(test):
        parts.append(Condition(_name_of(test), lambda value: bool(test(value))))
    elif test is not None:
        parts.append(Condition(f"equal to {test!r}", lambda value: bool(value == test)))
    if equals is not _UNSET:
        parts.append(_equal(equals, tolerance))
    if above is not None:
        parts.append(Condition(f"above {above:g}", lambda value: value > above, lambda value: above - value))
    if below is not None:
        parts.append(Condition(f"below {below:g}", lambda value: value < below, lambda value: value - below))
    if between is not None:
        low, high = between
        parts.append(
            Condition(
                f"between {low:g} and {high:g}",
                lambda value: low <= value <= high,
                lambda value: max(low - value, value - high),
            )
        )
    if fields:
        parts.append(_fields(fields, tolerance, tolerance if yaw_tolerance is None else yaw_tolerance))
    if not parts:
        raise UserError("the assertion has no condition: give a function, equals=, above=, below=, between= or fields")
    return _all_of(parts)


def _all_of(parts: list[Condition]) -> Condition:
    if len(parts) == 1:
        return parts[0]
    text = " and ".join(part.text for part in parts)
    return Condition(text, lambda value: all(part.holds(value) for part in parts))


def _equal(wanted: Any, tolerance: float) -> Condition:
    if isinstance(wanted, bool | str) or not isinstance(wanted, int | float):
        return Condition(f"{wanted!r}", lambda value: bool(value == wanted))
    within = f" within {tolerance:g}" if tolerance else ""
    return Condition(
        f"{wanted:g}{within}", lambda value: abs(value - wanted) <= tolerance, lambda value: abs(value - wanted)
    )


def _fields(wanted: Mapping[str, Any], tolerance: float, yaw_tolerance: float) -> Condition:
    words = [
        f"{name} {value:g}" if isinstance(value, float | int) else f"{name} {value!r}" for name, value in wanted.items()
    ]
    within = f" within {tolerance:g}" if tolerance else ""

    def differences(value: Any) -> list[tuple[float, float]]:
        found = []
        for name, goal in wanted.items():
            actual = read_field(value, name)
            if isinstance(goal, float | int) and not isinstance(goal, bool):
                is_angle = name.rsplit(".", 1)[-1] in _ANGLES
                difference = math.remainder(actual - goal, math.tau) if is_angle else actual - goal
                found.append((abs(difference), yaw_tolerance if is_angle else tolerance))
            else:
                found.append((0.0 if actual == goal else math.inf, 0.0))
        return found

    return Condition(
        ", ".join(words) + within,
        lambda value: all(difference <= limit for difference, limit in differences(value)),
        lambda value: math.hypot(*(difference for difference, _ in differences(value))),
    )


def read_field(value: Any, path: str) -> Any:
    """Return a part of a value: ``pose.pose.position.x``, ``ranges[0]``.

    Raises
    ------
    UserError
        When there is none, with the fields that there are.
    """
    for part in path.replace("[", ".[").split("."):
        if not part:
            continue
        try:
            value = value[int(part[1:-1])] if part.startswith("[") else getattr(value, part)
        except (AttributeError, IndexError, TypeError, ValueError):
            kind = type(value).__name__
            known = list(getattr(value, "get_fields_and_field_types", dict)()) or [
                name for name in dir(value) if not name.startswith("_")
            ]
            raise UserError(f"'{path}': {kind} has no '{part}'{hint(part, known)}") from None
    return value


def _name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function, or the text of a lambda where its source is at hand."""
    name = getattr(function, "__name__", repr(function))
    return f"as {name}() requires" if name != "<lambda>" else "as the function requires"
