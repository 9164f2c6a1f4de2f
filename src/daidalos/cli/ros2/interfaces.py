"""Classes and messages from names and values on the command line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros2cli.interfaces import interface_names

from daidalos.cli.ros2.errors import CliError
from daidalos.common import documents
from daidalos.common.suggestions import did_you_mean, near


def message_class(name: str, fault: str = "The passed message type is invalid") -> Any:
    """Return the class of a message; CliError with `fault` and a hint if it does not exist."""
    return _class("msg", name, fault)


def service_class(name: str, fault: str = "The passed service type is invalid") -> Any:
    """Return the class of a service; see `message_class`."""
    return _class("srv", name, fault)


def action_class(name: str, fault: str = "The passed action type is invalid") -> Any:
    """Return the class of an action; see `message_class`."""
    return _class("action", name, fault)


def _class(kind: str, name: str, fault: str) -> Any:
    from rosidl_runtime_py import utilities

    find = {"msg": utilities.get_message, "srv": utilities.get_service, "action": utilities.get_action}[kind]
    try:
        return find(name)
    except (ImportError, AttributeError, ValueError):
        raise CliError(f"{fault}{_help(kind, name)}") from None


def _help(kind: str, name: str) -> str:
    """Return hints about an unknown type; empty if the package is known and no name is similar."""
    known = interface_names(kind)
    if near(name, known):
        return did_you_mean(name, known)
    parts = name.split("/")
    package = parts[0]
    if len(parts) in (2, 3) and all(parts) and not any(one.startswith(f"{package}/") for one in known):
        return (
            f"\nThe package '{package}' is not here. Install it, or build it in a workspace with "
            f"`colcon build --packages-select {package}` and source its install/setup.bash."
        )
    return ""


def parse_values(text: str) -> dict[str, Any]:
    """Return the dictionary of YAML on the command line; CliError, with the position, if it is invalid."""
    values = parse_yaml(text)
    if values is None:
        return {}
    if not isinstance(values, dict):
        raise CliError("The passed value needs to be a dictionary in YAML format")
    return values


def parse_yaml(text: str) -> Any:
    """Return the value of YAML on the command line; CliError, with the position, if it is malformed."""
    try:
        return documents.parse_yaml(text)
    except documents.DocumentError as error:
        raise CliError(f"The passed value is not valid YAML: {error.described}") from None


def fill(
    message: Any, values: dict[str, Any], fault: Callable[[Exception], str] = "Failed to populate field: {}".format
) -> list[Callable[[Any], None]]:
    """Set a message's fields.

    Parameters
    ----------
    message
        What is changed.
    values
        By field name.
    fault
        Makes the text of the CliError from what went wrong.

    Returns
    -------
    list of functions
        Each sets one time to the stamp it is called with: those given as ``now``, and headers given as
        ``auto``.
    """
    from rosidl_runtime_py import set_message_fields

    try:
        stampers: list[Callable[[Any], None]] = set_message_fields(
            message, values, expand_header_auto=True, expand_time_now=True
        )
    except (AttributeError, TypeError, ValueError, AssertionError, OverflowError) as error:
        raise CliError(fault(error) + _near_fields(error)) from None
    return stampers


def _near_fields(error: Exception) -> str:
    holder = getattr(error, "obj", None)
    if holder is None or not hasattr(holder, "get_fields_and_field_types"):
        return ""
    field, colon, value = str(error.name).partition(":")  # type: ignore[attr-defined]
    if colon and field in holder.get_fields_and_field_types():
        return f"\nDid you mean '{field}: {value}'? YAML wants a space after the colon"
    known = holder.get_fields_and_field_types()
    return did_you_mean(error.name, known)  # type: ignore[attr-defined]
