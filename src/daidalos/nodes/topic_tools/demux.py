"""`demux`: republishes a topic on one of several topics."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from daidalos.nodes.topic_tools._forwarding import TopicForwarder
from daidalos.nodes.topic_tools._switch import NONE, Switch
from daidalos.nodes.topic_tools._tool import run_tool


class DemuxNode(Switch):
    """Node that republishes ``input_topic`` on the selected one of ``output_topics``; see `MuxNode`."""

    def __init__(self, **kwargs: Any) -> None:
        from topic_tools_interfaces.srv import DemuxAdd, DemuxDelete, DemuxList, DemuxSelect

        super().__init__("demux", "output_topics", (DemuxAdd, DemuxDelete, DemuxList, DemuxSelect), **kwargs)
        source = str(self.declare_parameter("input_topic", "~/input").value)
        lazy = bool(self.declare_parameter("lazy", False).value)
        self._passage = TopicForwarder(self, self._forward_message, self.topics, lazy=lazy)
        self._passage.take_from(source)
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


if __name__ == "__main__":
    sys.exit(main())
