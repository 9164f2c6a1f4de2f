"""Entity filters of `simulation_interfaces`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.nodes.gazebo_ros._states import vector_of
from daidalos.simulation import Simulation

_POSIX_CLASSES = {
    "[:alnum:]": "a-zA-Z0-9",
    "[:alpha:]": "a-zA-Z",
    "[:digit:]": "0-9",
    "[:lower:]": "a-z",
    "[:upper:]": "A-Z",
    "[:space:]": r"\s",
}


class FilterError(ValueError):
    """Invalid filter."""


def matching(simulation: Simulation, filters: Any, info_of: Callable[[str], Any]) -> list[str]:
    """Return the names of the models that all filters let through.

    Parameters
    ----------
    simulation : Simulation
    filters : simulation_interfaces.msg.EntityFilters
    info_of : callable
        Returns a model's ``EntityInfo``.

    Raises
    ------
    FilterError
    """
    pattern = _pattern(filters.filter)
    categories = {each.category for each in filters.categories}
    overlaps = _overlap(filters.bounds)
    names = []
    for name in simulation.models:
        info = info_of(name)
        fits = not categories or info.category.category in categories
        if fits and pattern.search(name) and has_tags(info.tags, filters.tags) and overlaps(*simulation.bounds(name)):
            names.append(name)
    return names


def has_tags(tags: Iterable[str], wanted: Any) -> bool:
    """Return whether all or any of a ``TagsFilter``'s tags are present; an empty filter matches everything."""
    matches = [tag in tags for tag in wanted.tags]
    return not matches or (all(matches) if wanted.filter_mode == wanted.FILTER_MODE_ALL else any(matches))


def _pattern(text: str) -> re.Pattern[str]:
    """Compile a POSIX extended regular expression, as far as it differs from Python's."""
    python = text
    for posix, characters in _POSIX_CLASSES.items():
        python = python.replace(posix, characters)
    try:
        return re.compile(python)
    except re.error as error:
        raise FilterError(f"{text!r} is not a regular expression: {error}") from None


def _overlap(bounds: Any) -> Callable[[NDArray[np.float64], NDArray[np.float64]], bool]:
    """Return a function that tests whether a box given by two corners overlaps some bounds."""
    if bounds.type == bounds.TYPE_EMPTY:
        return lambda low, high: True
    if bounds.type not in (bounds.TYPE_BOX, bounds.TYPE_SPHERE):
        raise FilterError("bounds that are neither a box nor a sphere are not supported")
    if len(bounds.points) != 2:
        raise FilterError(f"a box or a sphere has 2 points, got {len(bounds.points)}")
    first, second = (np.array(vector_of(point)) for point in bounds.points)
    if bounds.type == bounds.TYPE_SPHERE:
        return lambda low, high: bool(np.linalg.norm(np.clip(first, low, high) - first) <= second[0])
    lowest, highest = np.minimum(first, second), np.maximum(first, second)
    return lambda low, high: bool((low <= highest).all() and (high >= lowest).all())
