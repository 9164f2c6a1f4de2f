"""Topics, services and actions of a graph."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, names_and_types
from ros2cli.graph import NamesAndTypes, visible

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
