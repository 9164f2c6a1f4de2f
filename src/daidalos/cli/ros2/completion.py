"""Shell completion of arguments, called by argcomplete."""

from __future__ import annotations

from argparse import Action, Namespace
from collections.abc import Callable, Iterable
from typing import Any

from ros2cli.graph import NamesAndTypes

from daidalos.cli.ros2 import graph as graphs
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.transport.graph import Graph

Completer = Callable[..., Iterable[str]]


def complete(action: Action, completer: Completer) -> Action:
    """Set the completer of an argument, called as ``completer(prefix=..., parsed_args=...)``."""
    action.completer = completer  # type: ignore[attr-defined]
    return action


def complete_topics(action: Action) -> Action:
    """Return the topics that complete an argument."""
    return complete(action, lambda parsed_args, **_: _names(parsed_args, graphs.topics, "include_hidden_topics"))


def complete_services(action: Action) -> Action:
    """Return the services that complete an argument."""
    return complete(action, lambda parsed_args, **_: _names(parsed_args, graphs.services, "include_hidden_services"))


def complete_actions(action: Action) -> Action:
    """Return the actions that complete an argument."""
    return complete(
        action,
        lambda parsed_args, **_: _names(parsed_args, lambda graph, hidden: graphs.all_actions(graph), ""),
    )


def complete_nodes(action: Action, hidden_key: str = "include_hidden_nodes") -> Action:
    """Return the full names of nodes that complete an argument."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        with graph_view(parsed_args) as graph:
            return [node.full_name for node in graphs.nodes(graph, getattr(parsed_args, hidden_key, False))]

    return complete(action, names)


def complete_types(action: Action, kind: str, name_key: str | None = None) -> Action:
    """Return types (``msg``, ``srv``, ``action``), or only those of the entity that another argument names."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        from ros2cli.interfaces import interface_names

        name = getattr(parsed_args, name_key, None) if name_key else None
        if name:
            with graph_view(parsed_args) as graph:
                found = graphs.types_of(_LISTS[kind](graph), graphs.absolute(name))
            if found:
                return found
        return interface_names(kind)

    return complete(action, names)


def complete_values(action: Action, type_key: str) -> Action:
    """Return the default values of the type that another argument names."""

    def values(parsed_args: Namespace, **_: Any) -> list[str]:
        from ros2cli.interfaces import prototype

        return [prototype(getattr(parsed_args, type_key))]

    return complete(action, values)


def complete_packages(action: Action) -> Action:
    """Return the packages that complete an argument."""

    def names(**_: Any) -> list[str]:
        from daidalos.cli.ros2.packages import package_names

        return package_names()

    return complete(action, names)


def complete_executables(action: Action, package_key: str = "package_name") -> Action:
    """Return the executables of the package that another argument names."""

    def names(parsed_args: Namespace, **_: Any) -> list[str]:
        from daidalos.workspaces.executables import executables

        return executables(getattr(parsed_args, package_key))

    return complete(action, names)


_LISTS: dict[str, Callable[[Graph], NamesAndTypes]] = {
    "msg": graphs.topics,
    "srv": graphs.services,
    "action": graphs.all_actions,
}


def _names(parsed_args: Namespace, list_of: Callable[..., NamesAndTypes], hidden_key: str) -> list[str]:
    with graph_view(parsed_args) as graph:
        return [name for name, _ in list_of(graph, getattr(parsed_args, hidden_key, False))]
