"""Interfaces: messages, services and actions."""

from __future__ import annotations

from typing import Any

from ros2cli.interfaces import interface_names


def package_name_completer(**kwargs: Any) -> list[str]:
    """Return the packages that have interfaces."""
    from rosidl_runtime_py import get_interface_packages

    return list(get_interface_packages())


def type_completer(**kwargs: Any) -> list[str]:
    """Return the types of all interfaces, sorted."""
    return sorted(name for kind in ("msg", "srv", "action") for name in interface_names(kind))


def interface_to_yaml(identifier: str) -> str:
    """Return a message, a service's request or an action's goal with default values, as YAML.

    Parameters
    ----------
    identifier
        Type, such as ``std_msgs/msg/String``.
    """
    from rosidl_runtime_py import message_to_yaml
    from rosidl_runtime_py.utilities import get_interface

    found: Any = get_interface(identifier)
    kind = getattr(found, "Request", None) or getattr(found, "Goal", None) or found
    return message_to_yaml(kind())
