"""Navigation's extensions as Nav2's parameter files describe them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

from rclpy.node import Node

from daidalos.common.extensions import Kind, find
from daidalos.navigation.contracts import NavigationContext
from daidalos.nodes.parameters import declare, declare_name, location_of

T = TypeVar("T")


class ExtensionMaker:
    """Factory of extensions with the parameters of a node.

    Parameters
    ----------
    node : Node
        Whose parameters they are.
    context : NavigationContext
        What they may use.
    """

    def __init__(self, node: Node, context: NavigationContext) -> None:
        self._node = node
        self._context = replace(context, warn=self._warn)

    def _warn(self, line: str) -> None:
        self._node.get_logger().warning(line)

    def make(self, kind: Kind[T], name: str, default: str, defaults: Mapping[str, Any] | None = None) -> T:
        """Create the extension of the parameter ``<name>.plugin``.

        Parameters
        ----------
        kind : Kind
        name : str
            As in parameter files.
        default : str
            Class where the parameter is not given.
        defaults : mapping or None
            Defaults of the extension's parameters that are known only now, by name.

        Raises
        ------
        ExtensionError
            There is no such class, or it cannot be used.
        """
        parameter = f"{name}.plugin"
        chosen = declare_name(self._node, parameter, default, "Class of the plugin.")
        made: T = self._make(find(kind, chosen, asked_by=location_of(self._node, parameter)), name, defaults)
        return made

    def _make(self, cls: Any, name: str, defaults: Mapping[str, Any] | None = None) -> Any:
        def make(kind: Kind[Any], chosen: str, parameter: str, below: str) -> Any:
            found = find(kind, chosen, asked_by=location_of(self._node, f"{name}.{parameter}"))
            return self._make(found, f"{name}.{below}" if below else name)

        context = replace(self._context, name=name, maker=make)
        made: list[Any] = []
        parameters = None
        if cls.Parameters is not None:
            parameters = declare(self._node, cls.Parameters, name, lambda new: made[0].reconfigure(new), defaults)
        made.append(cls(parameters, context))
        return made[0]
