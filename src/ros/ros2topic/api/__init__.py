"""Topics and their types, and qualities of service as the command line names them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

from ros2cli.graph import NameCompleter, NamesAndTypes, TypeCompleter, class_of, visible
from ros2cli.interfaces import interface_names, prototype
from ros2cli.qos import add_qos_arguments as add_qos_arguments
from ros2cli.qos import profile_configure_short_keys as profile_configure_short_keys
from ros2cli.qos import qos_profile_from_short_keys as qos_profile_from_short_keys

Number = TypeVar("Number", int, float)


def get_topic_names_and_types(*, node: Any, include_hidden_topics: bool = False) -> NamesAndTypes:
    """Return the topics in the graph with their types.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    include_hidden_topics
        Whether those with a part that begins with an underscore are among them.
    """
    return visible(node.get_topic_names_and_types(), include_hidden_topics)


def get_topic_names(*, node: Any, include_hidden_topics: bool = False) -> list[str]:
    """Return the names of the topics in the graph; see `get_topic_names_and_types`."""
    return [name for name, _ in get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics)]


def get_msg_class(node: Any, topic: str, blocking: bool = False, include_hidden_topics: bool = False) -> Any:
    """Return the class of a topic's messages; None where nobody knows the topic.

    Parameters
    ----------
    node
        Who asks: an rclpy node or a `NodeStrategy`.
    topic
        The topic.
    blocking
        Whether to wait for a topic that is not there.
    include_hidden_topics
        Whether it may be a hidden topic.

    Raises
    ------
    RuntimeError
        When the topic has more than one type, or one that is not known here.
    """
    from rosidl_runtime_py.utilities import get_message

    def listing() -> NamesAndTypes:
        return get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics)

    return class_of(node, "topic", node.resolve_topic_name(topic), listing, get_message, blocking)


def unsigned_int(string: str) -> int:
    """Read a whole number that is not negative; for argparse."""
    return _number(string, int, lambda value: value >= 0, "non-negative integer")


def positive_int(string: str) -> int:
    """Read a whole number above 0; for argparse."""
    return _number(string, int, lambda value: value > 0, "a positive integer")


def positive_float(inval: str) -> float:
    """Read a number above 0; for argparse."""
    return _number(inval, float, lambda value: value > 0, "a positive number")


def message_type_completer(**kwargs: Any) -> list[str]:
    """Return all message types."""
    return interface_names("msg")


class TopicNameCompleter(NameCompleter):
    """Completer of the topics that an argument may be.

    Parameters
    ----------
    include_hidden_topics_key
        The argument that says whether hidden topics are among them.
    """

    def __init__(self, *, include_hidden_topics_key: str | None = None) -> None:
        super().__init__(
            lambda node, hidden: get_topic_names(node=node, include_hidden_topics=hidden), include_hidden_topics_key
        )


class TopicTypeCompleter(TypeCompleter):
    """Completer of the types that an argument may be: those of the topic which another argument names, or all.

    Parameters
    ----------
    topic_name_key
        The other argument.
    """

    def __init__(self, *, topic_name_key: str | None = None) -> None:
        super().__init__(_types_of, message_type_completer, topic_name_key)


class TopicMessagePrototypeCompleter:
    """Completer of the default message, as YAML, of the type that another argument names.

    Parameters
    ----------
    topic_type_key
        The other argument.
    """

    def __init__(self, *, topic_type_key: str) -> None:
        self.topic_type_key = topic_type_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **kwargs: Any) -> list[str]:
        """Return it."""
        return [prototype(getattr(parsed_args, self.topic_type_key))]


def _types_of(node: Any, topic: str) -> list[str]:
    return dict(get_topic_names_and_types(node=node, include_hidden_topics=True)).get(
        node.resolve_topic_name(topic), []
    )


def _number(string: str, kind: type[Number], is_good: Callable[[Number], bool], words: str) -> Number:
    with suppress(ValueError):
        value = kind(string)
        if is_good(value):
            return value
    raise argparse.ArgumentTypeError(f"value must be {words}, not '{string}'")
