"""Simulated sensors: inputs that depend on where the tool is."""

from __future__ import annotations

import re
from collections.abc import Callable

_SENSOR = re.compile(r"\s*(\w+)\s*=\s*([xyz])\s*([<>])\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*")


def parse_sensor(text: str) -> tuple[str, Callable[[list[float]], float]]:
    """Return the name of an input and the function of the tool's position [mm], of a text such as ``diTouch=z<120``.

    Raises
    ------
    ValueError
        Where the text is none.
    """
    match = _SENSOR.fullmatch(text)
    if match is None:
        raise ValueError(f"'{text}' is no sensor; write NAME=AXIS<MM or NAME=AXIS>MM, such as diTouch=z<120")
    axis, sign, border = "xyz".index(match[2]), -1.0 if match[3] == "<" else 1.0, float(match[4])
    return match[1], lambda position: float(sign * (position[axis] - border) > 0.0)
