"""Publishers of the values of expressions over another topic's messages."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future

from daidalos.nodes.runner import UserError, program_arguments, run_program

_TIMEOUT_S = 2.0


def parser(program: str, description: str) -> argparse.ArgumentParser:
    """Return a parser of what `relay_field` and `transform` have in common."""
    made = argparse.ArgumentParser(prog=program, description=description)
    made.add_argument("input", help="Input topic")
    made.add_argument("output_topic", help="Output topic")
    made.add_argument("output_type", help="Type of the output topic, such as std_msgs/String")
    made.add_argument("-w", "--wait-for-start", action="store_true", help="Wait until there is an input topic")
    return made


def parse(made: argparse.ArgumentParser) -> argparse.Namespace:
    """Read the command line."""
    return made.parse_args(program_arguments())


def run_expression(name: str, arguments: argparse.Namespace, apply: Callable[[Any, Any], Any]) -> int:
    """Publish what `apply` makes of every message of a topic.

    Parameters
    ----------
    name
        The node's.
    arguments
        What `parse` returned.
    apply
        Called with a message and the class of the output; returns a message. Raises UserError where it cannot.
    """
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    def body() -> None:
        kind = _class(arguments.output_type)
        rclpy.init()
        node = Node(name)
        over = Future()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        try:
            source, input_kind, qos = _wait_for_input(node, executor, arguments)
            publisher = node.create_publisher(kind, arguments.output_topic, qos)

            def on_message(message: Any) -> None:
                try:
                    publisher.publish(apply(message, kind))
                except UserError as error:
                    if not over.done():
                        over.set_exception(error)

            node.create_subscription(input_kind, source, on_message, qos)
            executor.spin_until_future_complete(over)
            if over.done():
                over.result()
        finally:
            node.destroy_node()

    return run_program(body)


def evaluate(expression: str, names: dict[str, Any]) -> Any:
    """Return the value of a Python expression; a mistake in it is the user's."""
    try:
        return eval(expression, {}, names)
    except Exception as error:
        kind = type(error).__name__
        raise UserError(f"the expression '{expression}' cannot be evaluated: {kind}: {error}") from None


def _wait_for_input(node: Node, executor: Executor, arguments: argparse.Namespace) -> tuple[str, Any, Any]:
    """Return the input's name, class and quality of service once it is published."""
    source = node.resolve_topic_name(arguments.input)
    found = Future()

    def look() -> None:
        if node.count_publishers(source) and not found.done():
            found.set_result(None)

    guard = node.create_guard_condition(look)
    stop = node.handle.graph.listen(lambda added, what: guard.trigger())
    guard.trigger()
    try:
        executor.spin_until_future_complete(found, None if arguments.wait_for_start else _TIMEOUT_S)
    finally:
        stop()
    infos = node.get_publishers_info_by_topic(source)
    if not infos:
        if not node.context.ok():
            raise KeyboardInterrupt
        known = ", ".join(sorted(name for name, _ in node.get_topic_names_and_types()))
        raise UserError(f"nobody publishes {source}; there are: {known}; -w waits for it")
    return source, _class(infos[0].topic_type), infos[0].qos_profile


def _class(name: str) -> Any:
    from rosidl_runtime_py.utilities import get_message

    full = name if "/msg/" in name else name.replace("/", "/msg/", 1)
    try:
        return get_message(full)
    except (AttributeError, ImportError, ValueError):
        raise UserError(f"the message type '{name}' is unknown") from None
