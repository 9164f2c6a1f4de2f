"""`demux`: republishes a topic on one of several topics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import parameter
from daidalos.nodes.topic_tools._forwarding import TopicForwarder
from daidalos.nodes.topic_tools._switch import NONE, Switch, SwitchParameters
from daidalos.nodes.topic_tools._tool import run_tool


@dataclass(frozen=True)
class DemuxParameters(SwitchParameters):
    """Parameters of ``demux``."""

    output_topics: tuple[str, ...] = parameter(("",), "Topics of which one is published.")
    input_topic: str = parameter("~/input", "Topic to subscribe to.", not_empty=True)

    @property
    def choice(self) -> tuple[str, ...]:
        """Topics of which one is selected."""
        return self.output_topics


class DemuxNode(Switch):
    """Node that republishes ``input_topic`` on the selected one of ``output_topics``; see `MuxNode`."""

    def __init__(self, **kwargs: Any) -> None:
        from topic_tools_interfaces.srv import DemuxAdd, DemuxDelete, DemuxList, DemuxSelect

        super().__init__("demux", DemuxParameters, (DemuxAdd, DemuxDelete, DemuxList, DemuxSelect), **kwargs)
        self._passage = TopicForwarder(self, self._forward_message, self.topics, lazy=self.settings.lazy)
        self._passage.take_from(self.settings.input_topic)
        self.choose(self.chosen)

    def added(self, topic: str) -> None:
        """Publish on it, once it is chosen."""
        self._passage.add_output(topic)

    def removed(self, topic: str) -> None:
        """Publish on it no more."""
        self._passage.remove_output(topic)

    def _forward_message(self, content: bytes) -> None:
        if self.chosen != NONE:
            self._passage.publish(content, self.chosen)

    def destroy_node(self) -> None:
        """Destroy the node with its publishers and subscriptions."""
        self._passage.close()
        super().destroy_node()


def _read(words: Sequence[str]) -> dict[str, Any]:
    return {"input_topic": words[0], "output_topics": [words[1], *words[2:]]}


def main() -> int:
    """Run the node."""
    return run_tool(DemuxNode, "demux <intopic> <outtopic1> [outtopic2 ...]", _read)
