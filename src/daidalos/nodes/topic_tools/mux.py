"""`mux`: republishes one of several topics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.topic_tools._forwarding import TopicForwarder
from daidalos.nodes.topic_tools._switch import NONE, Switch, SwitchParameters
from daidalos.nodes.topic_tools._tool import run_tool


@dataclass(frozen=True)
class MuxParameters(SwitchParameters):
    """Parameters of ``mux``."""

    input_topics: tuple[str, ...] = parameter(("",), "Topics of which one is republished.")
    output_topic: str = parameter("~/selected_topic", "Topic to publish.", not_empty=True)

    @property
    def choice(self) -> tuple[str, ...]:
        """Topics of which one is selected."""
        return self.input_topics


class MuxNode(Switch):
    """Node that republishes the selected one of ``input_topics`` on ``output_topic``."""

    def __init__(self, **kwargs: Any) -> None:
        from topic_tools_interfaces.srv import MuxAdd, MuxDelete, MuxList, MuxSelect

        super().__init__("mux", MuxParameters, (MuxAdd, MuxDelete, MuxList, MuxSelect), **kwargs)
        output, lazy = self.settings.output_topic, self.settings.lazy
        self._passage = TopicForwarder(self, lambda content: self._passage.publish(content), [output], lazy=lazy)
        self.choose(self.chosen)

    def choose(self, topic: str) -> None:
        """Listen to another one."""
        super().choose(topic)
        self._passage.take_from("" if topic == NONE else topic)

    def destroy_node(self) -> None:
        """Destroy the node with its publishers and subscriptions."""
        self._passage.close()
        super().destroy_node()


def _read(words: Sequence[str]) -> dict[str, Any]:
    return {"output_topic": words[0], "input_topics": [words[1], *words[2:]]}


def main() -> int:
    """Run the node."""
    return run_tool(MuxNode, "mux <outtopic> <intopic1> [intopic2 ...]", _read)
