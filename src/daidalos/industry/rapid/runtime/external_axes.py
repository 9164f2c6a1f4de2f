"""External axes of an arm, such as a track or a positioner: they move in proportion to the arm's own movement."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from daidalos.industry.rapid.runtime.errors import FatalError

LETTERS = "abcdef"
UNUSED = 9e9
_USED_BELOW = 8e9
_SMALLEST = 1e-9


@dataclass(frozen=True)
class ExternalAxis:
    """An external axis.

    Attributes
    ----------
    kind
        ``linear`` [mm] or ``turn`` [deg].
    lower, upper
        Range [mm or deg].
    speed
        Greatest speed [mm/s or deg/s].
    """

    kind: Literal["linear", "turn"]
    lower: float
    upper: float
    speed: float


def parse_axis(text: str) -> tuple[str, ExternalAxis]:
    """Return the letter and the axis of a text such as ``a=linear,0,4000,1000``.

    Raises
    ------
    ValueError
        Where it is none.
    """
    letter, _, rest = text.partition("=")
    kind, *numbers = rest.split(",")
    try:
        lower, upper, speed = map(float, numbers)
    except ValueError:
        lower = upper = speed = math.nan
    if letter not in tuple(LETTERS) or kind not in ("linear", "turn") or not (lower < upper and 0.0 < speed < math.inf):
        raise ValueError(
            f"'{text}' is no external axis; write LETTER=linear,LOWER,UPPER,SPEED, or turn in place of linear"
        )
    return letter, ExternalAxis("linear" if kind == "linear" else "turn", lower, upper, speed)


class ExternalAxes:
    """The external axes of an arm, by their letters; a movement of them begins and ends at rest.

    Parameters
    ----------
    axes
        The axes.
    """

    def __init__(self, axes: Mapping[str, ExternalAxis]) -> None:
        self._axes = {LETTERS.index(letter): axis for letter, axis in axes.items()}
        at_zero = [
            min(max(0.0, self._axes[i].lower), self._axes[i].upper) if i in self._axes else UNUSED for i in range(6)
        ]
        self._start, self._end = at_zero, list(at_zero)

    def goal(self, extax: list[Any]) -> list[float]:
        """Return where the axes go for the external axes of a target; those with 9E9 stay.

        Raises
        ------
        FatalError
            Where an axis would leave its range.
        """
        goal = list(self._end)
        for i, axis in self._axes.items():
            value = float(extax[i])
            if abs(value) >= _USED_BELOW:
                continue
            if not axis.lower <= value <= axis.upper:
                unit = "mm" if axis.kind == "linear" else "deg"
                text = f"eax_{LETTERS[i]} is {value:g} {unit}, and ranges from {axis.lower:g} to {axis.upper:g}"
                raise FatalError(f"50027 Joint out of range: {text}")
            goal[i] = value
        return goal

    def ignored(self, extax: list[Any]) -> list[str]:
        """Return the names of external axes that a target asks for and the arm does not have."""
        asked = [i for i, one in enumerate(extax) if i not in self._axes and one != 0.0 and abs(one) < _USED_BELOW]
        return [f"eax_{LETTERS[i]}" for i in asked]

    def is_there(self, goal: list[float]) -> bool:
        """Return whether the axes go or stand there already."""
        return all(abs(one - other) < _SMALLEST for one, other in zip(goal, self._end, strict=True))

    def seconds(self, goal: list[float], speed: list[float]) -> float:
        """Return the least time of the way at constant speeds, by speeddata and the axes' own limits."""
        longest = 0.0
        for i, axis in self._axes.items():
            limit = speed[2] if axis.kind == "linear" else speed[3]
            longest = max(longest, abs(goal[i] - self._end[i]) / min(axis.speed, limit if limit > 0.0 else axis.speed))
        return longest

    def go(self, goal: list[float]) -> None:
        """Start a movement."""
        self._start, self._end = self._end, list(goal)

    def values(self, share: float) -> list[float]:
        """Return the present values at a share of the movement, 0 to 1; 9E9 for axes that there are not."""
        return [
            a + share * (b - a) if i in self._axes else UNUSED
            for i, (a, b) in enumerate(zip(self._start, self._end, strict=True))
        ]
