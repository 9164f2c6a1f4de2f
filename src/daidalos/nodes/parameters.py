"""Parameters of nodes from the dataclasses in which the libraries document them."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any, TypeVar

from rclpy.node import Node

from daidalos.navigation.plugins import Plugin

T = TypeVar("T")
_PLAIN = (bool, int, float, str, list, tuple)


def declare_dataclass(node: Node, kind: type[T], prefix: str = "", **defaults: Any) -> T:
    """Declare a parameter for every field that a parameter can hold, and return the instance that they make.

    Parameters
    ----------
    node
        Whose parameters they are.
    kind
        A dataclass whose fields have defaults.
    prefix
        Put before the names, with a dot.
    **defaults
        Other defaults than the class's, by field.

    Raises
    ------
    ParameterException
        When a given value is of the wrong type.
    """
    values: dict[str, Any] = {}
    for field in fields(kind):  # type: ignore[arg-type]
        default = defaults.get(field.name, field.default)
        if default is MISSING or not isinstance(default, _PLAIN):
            continue
        name = f"{prefix}.{field.name}" if prefix else field.name
        declared = list(default) if isinstance(default, tuple) else default
        value = node.declare_parameter(name, declared).value
        values[field.name] = tuple(value) if isinstance(default, tuple) else value
    return kind(**values)


def declare_plugin(node: Node, plugin: Plugin, name: str) -> Any:
    """Declare the parameters of a plugin below its name; None where it has none."""
    return None if plugin.parameters is None else declare_dataclass(node, plugin.parameters, name)
