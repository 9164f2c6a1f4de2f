"""The names of the nodes that a launch has started."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch import LaunchContext

_KEY = "unique_ros_node_names"


def add_node_name(context: LaunchContext, node_name: str) -> None:
    """Remember that a node of this name was started."""
    counts: dict[str, int] | None = context.get_locals_as_dict().get(_KEY)
    if counts is None:
        counts = {}
        context.extend_globals({_KEY: counts})
    counts[node_name] = counts.get(node_name, 0) + 1


def get_node_name_count(context: LaunchContext, node_name: str) -> int:
    """Return how many nodes of this name were started."""
    counts: dict[str, int] = context.get_locals_as_dict().get(_KEY, {})
    return counts.get(node_name, 0)
