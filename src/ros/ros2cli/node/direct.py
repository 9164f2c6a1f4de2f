"""A node of a command's own."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from types import TracebackType
from typing import TYPE_CHECKING, Any

from daidalos.cli.ros2.direct import add_direct_arguments, direct_node

if TYPE_CHECKING:
    from rclpy.node import Node


class DirectNode:
    """A node in the graph, from the beginning to the end of a ``with`` block; it has the attributes of the node.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    node_name
        The node's name; a hidden one where None.
    """

    node: Node

    def __init__(self, args: Namespace, *, node_name: str | None = None) -> None:
        self._context = direct_node(args, node_name)

    def __enter__(self) -> DirectNode:
        self.node = self._context.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._context.__exit__(kind, error, trace)

    def __getattr__(self, name: str) -> Any:
        if name == "node":
            raise AttributeError("the node is there only within a `with` block")
        return getattr(self.node, name)


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the options of verbs that need a node of their own."""
    add_direct_arguments(parser)
