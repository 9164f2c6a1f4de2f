"""Queries of the graph for verbs."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable

from ros2cli.graph import NamesAndTypes
from ros2cli.listing import SERVICE_KINDS as SERVICE_KINDS
from ros2cli.listing import TOPIC_KINDS as TOPIC_KINDS
from ros2cli.listing import action_parties as action_parties
from ros2cli.listing import actions as actions
from ros2cli.listing import all_actions as all_actions
from ros2cli.listing import services as services
from ros2cli.listing import topics as topics

from daidalos.cli.ros2.errors import CliError
from daidalos.common.suggestions import near
from daidalos.transport.graph import Graph, NodeInfo

START_S = 10.0
"""How long a node that was just started may take to be in the graph [s]."""

MISSPELT_S = 1.0


def nodes(graph: Graph, include_hidden: bool = True) -> list[NodeInfo]:
    """Return the nodes, ordered by full name."""
    return [node for node in graph.nodes() if include_hidden or not node.name.startswith("_")]


def wait_for_name(graph: Graph, name: str, known: Callable[[], Collection[str]], limit_s: float | None = None) -> bool:
    """Return whether a name is known, or becomes known while its program may still be starting.

    Parameters
    ----------
    graph
        Changes of this graph end the wait early.
    name
        The full name of a node.
    known
        Returns the known names.
    limit_s
        How long to wait [s]; None for `START_S`, which is said, where a program has just been started, and for a part
        of it where none has, or a near name is known: then the name is rather misspelt.
    """
    if name in known():
        return True
    if limit_s is None:
        from daidalos.workspaces.executables import is_starting_something

        may_come = not near(name, known()) and is_starting_something(START_S)
        limit_s = START_S if may_come else MISSPELT_S
        if limit_s == START_S:
            print(f"waiting for '{name}', at most {START_S:g} s", file=sys.stderr, flush=True)
    return graph.wait_for(lambda: name in known(), limit_s)


def duplicate_names(found: Iterable[NodeInfo]) -> list[str]:
    """Return the full names that more than one node has."""
    return [name for name, count in Counter(node.full_name for node in found).items() if count > 1]


def absolute(name: str) -> str:
    """Return a name with a leading slash."""
    return name if name.startswith("/") else f"/{name}"


def check_type(found: NamesAndTypes, name: str, type_name: str) -> None:
    """Raise CliError if a service or action is served as another type than the one it is to be called with."""
    types = types_of(found, name)
    if types and type_name not in types:
        raise CliError(f"'{name}' has the type {' or '.join(types)}, not {type_name}")


def types_of(found: NamesAndTypes, name: str) -> list[str]:
    """Return the types of a topic, service or action; none if it does not exist."""
    return next((types for other, types in found if other == name), [])
