"""Parameters as messages, for nodes that are loaded by a service."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from daidalos.common.documents import DocumentError, read_yaml

from ..parameter_descriptions import Parameter
from .namespace_utils import make_namespace_absolute, prefix_namespace

if TYPE_CHECKING:
    from launch import LaunchContext


def to_parameters_list(
    context: LaunchContext, node_name: str | None, namespace: str | None, evaluated_parameters: Any
) -> list[Any]:
    """Return the messages of a node's parameters in their order; of several for one name the last counts.

    Parameters
    ----------
    context
        The launch context.
    node_name, namespace
        The node, for files in which nodes are named.
    evaluated_parameters
        What `evaluate_parameters` returned.
    """
    import rclpy.parameter

    values: list[tuple[str, Any]] = []
    for parameters in evaluated_parameters:
        if isinstance(parameters, pathlib.Path):
            values += _read_file(parameters, node_name, namespace).items()
        elif isinstance(parameters, Mapping):
            values += parameters.items()
        elif isinstance(parameters, Parameter):
            values.append(parameters.evaluate(context))
    return [
        rclpy.parameter.Parameter(
            name=name, value=list(value) if isinstance(value, tuple) else value
        ).to_parameter_msg()
        for name, value in values
    ]


def _read_file(path: pathlib.Path, node_name: str | None, namespace: str | None) -> dict[str, Any]:
    content = read_yaml(path) or {}
    if not isinstance(content, dict):
        raise DocumentError("expected node names at the top, each with 'ros__parameters' below", str(path))
    full_name = make_namespace_absolute(prefix_namespace(namespace, node_name) or "")
    sections = list(_sections(content, ""))
    if not sections:
        return _flatten(content, "")  # a file of names and values, whatever the node
    found: dict[str, Any] = {}
    for pattern, parameters in sorted(sections, key=lambda section: section[0] != "/**"):  # all others count more
        if _matches(pattern, full_name):
            found.update(_flatten(parameters, ""))
    return found


def _sections(content: Mapping[str, Any], path: str) -> Any:
    """Yield each node pattern of a file with its parameters; namespaces may be levels of their own."""
    for key, value in content.items():
        if key == "ros__parameters":
            yield path, value or {}
        elif isinstance(value, Mapping):
            yield from _sections(value, f"{path}/{str(key).strip('/')}")


def _matches(pattern: str, full_name: str) -> bool:
    """Return whether a pattern (`*` one level, `**` any number of levels) is for a node."""
    return _match_parts(pattern.strip("/").split("/"), full_name.strip("/").split("/"))


def _match_parts(pattern: list[str], parts: list[str]) -> bool:
    if not pattern:
        return not parts
    if pattern[0] == "**":
        return any(_match_parts(pattern[1:], parts[start:]) for start in range(len(parts) + 1))
    return bool(parts) and pattern[0] in ("*", parts[0]) and _match_parts(pattern[1:], parts[1:])


def _flatten(parameters: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            flat.update(_flatten(value, f"{prefix}{name}."))
        else:
            flat[f"{prefix}{name}"] = value
    return flat
