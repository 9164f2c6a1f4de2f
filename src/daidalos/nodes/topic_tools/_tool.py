"""Common base of the tools with one input and one output."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.utilities import remove_ros_args

from daidalos.nodes.runner import run
from daidalos.nodes.topic_tools._forwarding import TopicForwarder


class Tool(Node):
    """Node that subscribes to ``input_topic`` and publishes ``output_topic``; both are parameters, as is ``lazy``.

    Parameters
    ----------
    name
        The node's name, and the ending of the output's topic unless that is given.
    """

    def __init__(self, name: str, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        source = str(self.declare_parameter("input_topic", "").value)
        if not source:
            raise RuntimeError(f"{name} needs the parameter 'input_topic'")
        output = str(self.declare_parameter("output_topic", f"{source}_{name}").value)
        lazy = bool(self.declare_parameter("lazy", False).value)
        self.passage = TopicForwarder(self, self.receive, [output], lazy=lazy)
        self.passage.take_from(source)

    def receive(self, content: bytes) -> None:
        """Process a message."""
        self.passage.publish(content)

    def destroy_node(self) -> None:
        """Destroy the node with its publishers and subscriptions."""
        self.passage.close()
        super().destroy_node()


def run_tool(make: Callable[..., Node], usage: str, read: Callable[[Sequence[str]], dict[str, Any]]) -> int:
    """Run a tool whose parameters the command line gives by position, or as parameters.

    Parameters
    ----------
    make
        The node's class.
    usage
        Shown when the words can not be read.
    read
        Turns words into parameters; raises ValueError or IndexError where it can not.
    """
    words = remove_ros_args(sys.argv)[1:]
    if set(words) & {"-h", "--help"}:
        print(f"usage: {usage}")
        return 0
    try:
        given = read(words) if words else {}
    except (ValueError, IndexError):
        print(f"usage: {usage}", file=sys.stderr)
        return 1
    overrides: list[Any] = [Parameter(name, value=value) for name, value in given.items()]
    return run(lambda: make(parameter_overrides=overrides))


def topics(source: str, *output: str) -> dict[str, Any]:
    """Return the parameters of an input and, where it is given, an output."""
    if len(output) > 1:
        raise ValueError("too many words")
    return {"input_topic": source} | ({"output_topic": output[0]} if output else {})
