"""Actions and their types."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from rclpy.expand_topic_name import expand_topic_name
from rclpy.validate_full_topic_name import validate_full_topic_name
from ros2cli.graph import NamesAndTypes
from ros2cli.interfaces import interface_names, prototype
from ros2cli.node.strategy import NodeStrategy


def get_action_clients_and_servers(*, node: Any, action_name: str) -> tuple[NamesAndTypes, NamesAndTypes]:
    """Return the nodes that call an action and those that serve it, each as (full node name, types).

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    action_name
        The action.

    Raises
    ------
    ValueError
        When the name breaks the rules.
    """
    name = expand_topic_name(action_name, node.get_name(), node.get_namespace())
    validate_full_topic_name(name)
    clients: NamesAndTypes = []
    servers: NamesAndTypes = []
    for node_name, namespace in node.get_node_names_and_namespaces():
        full_name = f"{namespace.rstrip('/')}/{node_name}"
        called = node.get_action_client_names_and_types_by_node(node_name, namespace)
        served = node.get_action_server_names_and_types_by_node(node_name, namespace)
        clients += [(full_name, types) for other, types in called if other == name]
        servers += [(full_name, types) for other, types in served if other == name]
    return clients, servers


def get_action_names_and_types(*, node: Any) -> NamesAndTypes:
    """Return the actions in the graph with their types; `node` asks."""
    found: NamesAndTypes = node.get_action_names_and_types()
    return found


def get_action_names(*, node: Any) -> list[str]:
    """Return the names of the actions in the graph; `node` asks."""
    return [name for name, _ in get_action_names_and_types(node=node)]


def action_name_completer(prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
    """Return the actions that an argument may be."""
    with NodeStrategy(parsed_args) as node:
        return get_action_names(node=node)


def action_type_completer(**kwargs: Any) -> list[str]:
    """Return all action types."""
    return interface_names("action")


class ActionTypeCompleter:
    """Completer of the types that an argument may be: those of the action which another argument names, or all.

    Parameters
    ----------
    action_name_key
        The other argument.
    """

    def __init__(self, *, action_name_key: str | None = None) -> None:
        self.action_name_key = action_name_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        if self.action_name_key is None:
            return action_type_completer()
        with NodeStrategy(parsed_args) as node:
            found = dict(get_action_names_and_types(node=node))
        return found.get(getattr(parsed_args, self.action_name_key), [])


class ActionGoalPrototypeCompleter:
    """Completer of the default goal, as YAML, of the type that another argument names.

    Parameters
    ----------
    action_type_key
        The other argument.
    """

    def __init__(self, *, action_type_key: str) -> None:
        self.action_type_key = action_type_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return it."""
        return [prototype(getattr(parsed_args, self.action_type_key))]
