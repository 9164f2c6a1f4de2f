"""Extensions of `ros2` as objects, and the version of the interface between `ros2` and them."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ros2cli.entry_points import load_entry_points

PLUGIN_SYSTEM_VERSION = "0.1"

logger = logging.getLogger(__name__)

_instances: dict[type, Any] = {}


class PluginException(RuntimeError):
    """Error of the plugin system."""


def instantiate_extensions(
    group_name: str, *, exclude_names: Iterable[str] | None = None, unique_instance: bool = False
) -> dict[str, Any]:
    """Return an object of each class of a group of entry points, by name.

    Those that cannot be imported or constructed are logged and left out.

    Parameters
    ----------
    group_name
        The group of entry points, such as ``ros2topic.verb``.
    exclude_names
        Names to leave out.
    unique_instance
        Whether to construct new objects instead of those that earlier calls returned.
    """
    found = {}
    for name, kind in load_entry_points(group_name, exclude_names=exclude_names).items():
        if not unique_instance and kind in _instances:
            found[name] = _instances[kind]
            continue
        try:
            instance = kind()
        except Exception as error:  # code of other packages may raise anything
            level = logging.WARNING if isinstance(error, PluginException) else logging.ERROR
            logger.log(level, "Failed to instantiate '%s' extension '%s': %s", group_name, name, error)
            continue
        if not unique_instance:
            _instances[kind] = instance
        found[name] = instance
    return found


def order_extensions(
    extensions: Mapping[str, Any], key_function: Callable[[tuple[str, Any]], Any], *, reverse: bool = False
) -> dict[str, Any]:
    """Return extensions sorted by ``key_function((name, extension))``."""
    return dict(sorted(extensions.items(), key=key_function, reverse=reverse))


def order_extensions_by_name(extensions: Mapping[str, Any]) -> dict[str, Any]:
    """Return extensions sorted by name."""
    return order_extensions(extensions, lambda pair: pair[0])


def satisfies_version(version: str, caret_range: str) -> None:
    """Check that a version is in a caret range.

    Parameters
    ----------
    version
        What is there, such as ``0.1``.
    caret_range
        What an extension was made for: ``^0.1`` means at least 0.1, and the first number that is not zero unchanged.

    Raises
    ------
    ValueError
        When either cannot be read.
    PluginException
        When the version is not in the range.
    """
    if not caret_range.startswith("^"):
        raise ValueError(f"'{caret_range}' is not a caret range, such as '^0.1'")
    there, wanted = _numbers(version), _numbers(caret_range[1:])
    fixed = next((place for place, number in enumerate(wanted) if number), len(wanted) - 1) + 1
    if there < wanted or there[:fixed] != wanted[:fixed]:
        raise PluginException(f"Extension point version '{version}' does not satisfy '{caret_range}'")


def _numbers(version: str) -> tuple[int, ...]:
    if not re.fullmatch(r"\d+(\.\d+)*", version):
        raise ValueError(f"'{version}' is not a version, such as '0.1'")
    return tuple(map(int, version.split(".")))
