"""Common base of the tools with one input and one output."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare, declare_name
from daidalos.nodes.runner import program_arguments, run
from daidalos.nodes.topic_tools._forwarding import TopicForwarder


@dataclass(frozen=True)
class ToolParameters(Parameters):
    """Parameters of all tools with one input and one output.

    The output is ``output_topic``, by default the input with the tool's name at its end, such as ``/chatter_relay``.
    """

    input_topic: str = parameter("", "Topic to subscribe to.", not_empty=True)
    lazy: bool = parameter(False, "Whether to subscribe only while the output has subscribers.")


class Tool(Node):
    """Node that subscribes to ``input_topic`` and publishes ``output_topic``.

    Parameters
    ----------
    name
        The node's name, and the ending of the output's topic unless that is given.
    """

    def __init__(self, name: str, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        settings = declare(self, ToolParameters)
        source = settings.input_topic
        output = declare_name(self, "output_topic", f"{source}_{name}", "Topic to publish.")
        self.passage = TopicForwarder(self, self.receive, [output], lazy=settings.lazy)
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
        Shown when the words cannot be read.
    read
        Turns words into parameters; raises ValueError or IndexError where it cannot.
    """
    words = program_arguments()
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
