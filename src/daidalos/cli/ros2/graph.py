"""Queries of the graph for verbs."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable

from ros2cli.graph import NamesAndTypes, visible

from daidalos.cli.ros2.errors import CliError
from daidalos.common.suggestions import near
from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo, names_and_types

START_S = 10.0
"""How long a node that was just started may take to be in the graph [s]."""

MISSPELT_S = 1.0
TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
SERVICE_KINDS = (EndpointKind.SERVICE, EndpointKind.CLIENT)
_FEEDBACK = "/_action/feedback"
_FEEDBACK_TYPE = "_FeedbackMessage"


def topics(graph: Graph, include_hidden: bool = True) -> NamesAndTypes:
    """Return the topics: [(name, [types])]."""
    return visible(names_and_types(graph.endpoints(*TOPIC_KINDS)), include_hidden)


def services(graph: Graph, include_hidden: bool = True) -> NamesAndTypes:
    """Return the services: [(name, [types])]."""
    return visible(names_and_types(graph.endpoints(*SERVICE_KINDS)), include_hidden)


def actions(endpoints: Iterable[EndpointInfo]) -> NamesAndTypes:
    """Return the actions of the feedback topics among endpoints: [(name, [types])]."""
    feedback = [one for one in endpoints if one.name.endswith(_FEEDBACK) and one.type_name.endswith(_FEEDBACK_TYPE)]
    return [
        (name.removesuffix(_FEEDBACK), [one.removesuffix(_FEEDBACK_TYPE) for one in types])
        for name, types in names_and_types(feedback)
    ]


def all_actions(graph: Graph) -> NamesAndTypes:
    """Return every action: [(name, [types])]."""
    return actions(graph.endpoints(*TOPIC_KINDS))


def action_parties(graph: Graph, action: str, kind: EndpointKind) -> list[EndpointInfo]:
    """Return the endpoints that serve (kind PUBLISHER) or call (kind SUBSCRIPTION) an action."""
    return graph.endpoints(kind, name=f"{action}{_FEEDBACK}")


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
