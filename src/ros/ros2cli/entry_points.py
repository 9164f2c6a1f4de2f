"""Entry points by which packages add commands, verbs and groups of verbs."""

from __future__ import annotations

import importlib.metadata
import logging
from collections.abc import Iterable
from importlib.metadata import Distribution, EntryPoint
from typing import Any

from daidalos.common.extensions import first_line

EXTENSION_POINT_GROUP_NAME = "ros2cli.extension_point"
"""Group in which packages declare the groups that their commands take verbs from."""

logger = logging.getLogger(__name__)


def get_all_entry_points() -> dict[str, dict[str, tuple[Distribution, EntryPoint]]]:
    """Return the extensions in all declared groups, with their distributions: {group: {name: (...)}}."""
    groups = get_entry_points(EXTENSION_POINT_GROUP_NAME)
    found: dict[str, dict[str, tuple[Distribution, EntryPoint]]] = {}
    for distribution in importlib.metadata.distributions():
        for point in distribution.entry_points:
            if point.group in groups:
                found.setdefault(point.group, {})[point.name] = (distribution, point)
    return found


def get_entry_points(group_name: str) -> dict[str, EntryPoint]:
    """Return the entry points of a group by name, without importing them."""
    return {point.name: point for point in importlib.metadata.entry_points(group=group_name)}


def load_entry_points(group_name: str, *, exclude_names: Iterable[str] | None = None) -> dict[str, Any]:
    """Import the entry points of a group; those that cannot be imported are logged and left out.

    Parameters
    ----------
    group_name
        The group.
    exclude_names
        Names to leave out.
    """
    excluded = set(exclude_names or ())
    found = {}
    for name, point in get_entry_points(group_name).items():
        if name in excluded:
            continue
        try:
            found[name] = point.load()
        except Exception as error:  # code of other packages may raise anything
            logger.warning("Failed to load entry point '%s': %s", name, error)
    return found


def get_first_line_doc(any_type: object) -> str:
    """Return the first line of a docstring without its full stop."""
    return first_line(any_type)
