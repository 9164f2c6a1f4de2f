"""Common parts of the commands' queries of topics, services and nodes."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from typing import Any

from ros2cli.node.strategy import NodeStrategy

NamesAndTypes = list[tuple[str, list[str]]]


def is_hidden(name: str) -> bool:
    """Return whether a token of the name of a topic, a service or a node begins with an underscore."""
    return any(token.startswith("_") for token in name.split("/"))


def visible(found: NamesAndTypes, include_hidden: bool) -> NamesAndTypes:
    """Return what is not hidden, or all.

    Parameters
    ----------
    found
        Topics or services with their types.
    include_hidden
        Whether to return all.
    """
    return found if include_hidden else [(name, types) for name, types in found if not is_hidden(name)]


def class_of(
    node: Any, what: str, name: str, listing: Callable[[], NamesAndTypes], find: Callable[[str], Any], blocking: bool
) -> Any:
    """Return the class of a topic's or a service's type; None where nobody knows it.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    what
        ``topic`` or ``service``.
    name
        Its name in full.
    listing
        Returns all of that kind.
    find
        Returns the class of a type.
    blocking
        Whether to wait for one that is not there.

    Raises
    ------
    RuntimeError
        When it has more than one type, or one that is not known here.
    """

    def types() -> list[str]:
        return dict(listing()).get(name, [])

    if not types():
        print(f"WARNING: {what} [{name}] does not appear to be published yet", flush=True)  # noqa: T201
        if not blocking:
            return None
        node.handle.graph.wait_for(lambda: bool(types()))
    found = types()
    if len(found) > 1:
        raise RuntimeError(f"Cannot echo {what} '{name}', as it contains more than one type: [{', '.join(found)}]")
    try:
        return find(found[0])
    except (AttributeError, ImportError, ValueError):
        raise RuntimeError(f"The {what} type '{found[0]}' is invalid") from None


def is_set(parsed_args: Namespace, key: str | None) -> bool:
    """Return whether a switch was given, if there is such a switch."""
    return bool(key and getattr(parsed_args, key, False))


class NameCompleter:
    """Completer of the names that an argument may be.

    Parameters
    ----------
    names
        Returns them, of a node and of whether hidden ones are among them.
    include_hidden_key
        The argument that says whether they are.
    """

    def __init__(self, names: Callable[[Any, bool], list[str]], include_hidden_key: str | None) -> None:
        self._names = names
        self._include_hidden_key = include_hidden_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        with NodeStrategy(parsed_args) as node:
            return self._names(node, is_set(parsed_args, self._include_hidden_key))


class TypeCompleter:
    """Completer of the types that an argument may be: those of what another argument names, or all.

    Parameters
    ----------
    types_of
        Returns the types of a name, asked by a node; none where nobody knows it.
    all_types
        Returns all.
    name_key
        The other argument.
    """

    def __init__(
        self, types_of: Callable[[Any, str], list[str]], all_types: Callable[[], list[str]], name_key: str | None
    ) -> None:
        self._types_of = types_of
        self._all_types = all_types
        self._name_key = name_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return them."""
        name = getattr(parsed_args, self._name_key, None) if self._name_key else None
        if name:
            with NodeStrategy(parsed_args) as node:
                found = self._types_of(node, name)
            if found:
                return found
        return self._all_types()
