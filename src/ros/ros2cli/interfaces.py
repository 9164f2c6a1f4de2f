"""Names of interfaces, and what a message looks like on the command line."""

from __future__ import annotations

import functools
from typing import Any


def interface_names(kind: str) -> list[str]:
    """Return the full names of the interfaces of a kind: ``msg``, ``srv`` or ``action``."""
    from rosidl_runtime_py.get_interfaces import get_interfaces

    found = get_interfaces()
    return [f"{package}/{name}" for package, names in found.items() for name in names if name.startswith(f"{kind}/")]


@functools.cache
def prototype(name: str) -> str:
    """Return a message, a service's request or an action's goal with default values, as one line of YAML."""
    import yaml
    from rosidl_runtime_py import message_to_ordereddict
    from rosidl_runtime_py.utilities import get_interface

    found = get_interface(name)
    instance = getattr(found, "Request", None) or getattr(found, "Goal", None) or found
    return yaml.safe_dump(_plain(message_to_ordereddict(instance())), default_flow_style=True, sort_keys=False).strip()


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list) else value
