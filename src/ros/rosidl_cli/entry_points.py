"""Entry points by which packages add generators and translators."""

from __future__ import annotations

import importlib.metadata
import logging
from collections.abc import Iterable
from importlib.metadata import EntryPoint
from typing import Any

from daidalos.common.suggestions import hint

logger = logging.getLogger(__name__)


def get_entry_points(
    group_name: str, *, specs: Iterable[str] | None = None, strict: bool = False
) -> dict[str, EntryPoint]:
    """Return the entry points of a group by name, without importing them.

    Parameters
    ----------
    group_name
        The group.
    specs
        Names of those that are wanted; all without it.
    strict
        Whether a name that is there twice or not at all is an error instead of a warning.

    Raises
    ------
    RuntimeError
        If `strict`.
    """
    wanted = set(specs or ())
    there: dict[str, EntryPoint] = {}
    for point in importlib.metadata.entry_points(group=group_name):
        if point.name in there and point != there[point.name]:
            _report(f"Found duplicate entry point '{point.name}': got {point} and {there[point.name]}", strict)
        else:
            there[point.name] = point
    for name in sorted(wanted - there.keys()):
        choice = hint(name, there) if there else "; no package has added one"
        _report(f"there is no '{name}' in {group_name}{choice}", strict)
    return {name: point for name, point in there.items() if not wanted or name in wanted}


def load_entry_points(group_name: str, *, specs: Iterable[str] | None, strict: bool = False) -> dict[str, Any]:
    """Import the entry points of a group; see `get_entry_points`.

    Raises
    ------
    RuntimeError
        If `strict`, for what is not there or can not be imported, which is logged and left out otherwise.
    """
    found = {}
    for name, point in get_entry_points(group_name, specs=specs, strict=strict).items():
        try:
            found[name] = point.load()
        except Exception as error:  # code of other packages may raise anything
            _report(f"Failed to load entry point '{name}': {error}", strict)
    return found


def _report(text: str, strict: bool) -> None:
    if strict:
        raise RuntimeError(text)
    logger.warning(text)
