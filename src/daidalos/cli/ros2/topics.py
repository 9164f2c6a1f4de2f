"""Common parts of the verbs of `ros2 topic`: topic names and types, waiting, and fields of messages."""

from __future__ import annotations

import contextlib
import re
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.graph import topics, types_of
from daidalos.cli.ros2.interfaces import message_class
from daidalos.cli.ros2.qos import qos_for_publishers, requested_qos
from daidalos.common.suggestions import did_you_mean, hint_line
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile
    from rclpy.subscription import Subscription
    from rclpy.task import Future


def add_window_argument(parser: ArgumentParser, default: int, description: str) -> None:
    """Declare ``--window``: how many of the latest messages count.

    Parameters
    ----------
    parser
        Of the verb.
    default
        The number where none is given.
    description
        Shown by ``--help``, before the default.
    """
    from ros2topic.api import positive_int

    parser.add_argument(
        "--window",
        "-w",
        type=positive_int,
        default=default,
        metavar="WINDOW",
        help=f"{description} (default: {default})",
    )


def topic_class(node: Node, topic: str, message_type: str | None = None, *, wait: bool = False) -> Any:
    """Return the class of a topic's messages.

    Parameters
    ----------
    node
        The node that asks.
    topic
        The topic.
    message_type
        The type where it is known.
    wait
        Whether to wait for a topic that is not there.

    Raises
    ------
    CliError
        When it has no type or more than one, or a type that is not known.
    """
    if message_type is not None:
        return message_class(message_type)
    graph = node.handle.graph
    name = node.resolve_topic_name(topic)
    types = types_of(topics(graph), name)
    if not types:
        print(f"WARNING: topic [{topic}] does not appear to be published yet", flush=True)
        known = [other for other, _ in topics(graph)]
        if not wait:
            raise CliError(f"Could not determine the type for the passed topic{did_you_mean(name, known)}")
        sys.stderr.write(hint_line(name, known))
        graph.wait_for(lambda: bool(types_of(topics(graph), name)))
        types = types_of(topics(graph), name)
    if len(types) > 1:
        raise CliError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]")
    return message_class(types[0], f"The message type '{types[0]}' is invalid")


class Field:
    """Field of a message as a path such as ``pose.position.x`` or ``ranges.[0]``.

    Raises
    ------
    CliError
        When a part of the path is empty.
    """

    def __init__(self, path: str) -> None:
        self.path = path
        self._parts = re.sub(r"(?<!\.)\[", ".[", path).split(".")
        if not all(self._parts):
            raise CliError(f"Invalid field value '{path}'")

    def of(self, message: Any) -> Any:
        """Return the field of a message; CliError if it does not exist."""
        value = message
        for part in self._parts:
            index = re.fullmatch(r"\[(-?\d+)\]", part)
            try:
                value = value[int(index.group(1))] if index else getattr(value, part)
            except (AttributeError, IndexError, TypeError) as error:
                fields = value.get_fields_and_field_types() if hasattr(value, "get_fields_and_field_types") else ()
                raise CliError(f"Invalid field '{self.path}': {error}{did_you_mean(part, fields)}") from None
        return value


def filter_function(expression: str) -> Callable[[Any], bool]:
    """Return a function that evaluates a Python expression of a message ``m``.

    Raises
    ------
    CliError
        When the expression is no Python; the function raises it when it cannot be evaluated.
    """
    import math

    try:
        code = compile(expression, "<expression>", "eval")
    except SyntaxError as error:
        raise CliError(f"Invalid filter expression '{expression}': {error.msg}") from None
    names = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}

    def passes(message: Any) -> bool:
        try:
            return bool(eval(code, {**names, "m": message}))
        except Exception as error:
            raise CliError(f"Failed to evaluate the filter expression '{expression}': {error}") from None

    return passes


def subscribe(
    node: Node, args: Namespace, topic: str, message_type: Any, on_message: Callable[..., Any], *, raw: bool = False
) -> None:
    """Pass every message of a topic to a function, with the requested QoS or that of the first publishers."""
    qos = requested_qos(args)
    graph, name = node.handle.graph, node.resolve_topic_name(topic)
    publishers = [] if qos is not None else graph.endpoints(EndpointKind.PUBLISHER, name=name)
    chosen = qos or qos_for_publishers(publishers)
    subscription = node.create_subscription(message_type, topic, on_message, chosen, raw=raw)
    if qos is None and not publishers:
        _adapt_to_first_publisher(node, subscription, name, chosen)


def _adapt_to_first_publisher(node: Node, subscription: Subscription, name: str, chosen: QoSProfile) -> None:
    """Replace a subscription where the topic's first publisher, once it is there, offers another QoS."""
    from rclpy.handle import InvalidHandle

    graph = node.handle.graph

    def adapt() -> None:
        publishers = graph.endpoints(EndpointKind.PUBLISHER, name=name)
        if not publishers or condition not in node.guards:
            return
        stop()
        node.destroy_guard_condition(condition)
        qos = qos_for_publishers(publishers)
        if qos != chosen:
            node.destroy_subscription(subscription)
            node.create_subscription(
                subscription.msg_type, subscription.topic, subscription.callback, qos, raw=subscription.raw
            )

    def look(added: bool, what: NodeInfo | EndpointInfo) -> None:
        with contextlib.suppress(InvalidHandle):  # the node is being destroyed
            condition.trigger()

    condition = node.create_guard_condition(adapt)
    stop = graph.listen(look)
    condition.trigger()  # it may have come meanwhile


def spin(node: Node, done: Future | None = None, timeout_s: float | None = None) -> None:
    """Run a node's callbacks until Ctrl-C, completion of the future or a timeout."""
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.task import Future

    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    executor.spin_until_future_complete(done or Future(), timeout_s)
