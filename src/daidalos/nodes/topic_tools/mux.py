"""`mux`: republishes one of several topics."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from daidalos.nodes.topic_tools._forwarding import TopicForwarder
from daidalos.nodes.topic_tools._switch import NONE, Switch
from daidalos.nodes.topic_tools._tool import run_tool


class MuxNode(Switch):
    """Node that republishes the selected one of ``input_topics`` on ``output_topic``.

    Parameters of the node besides: ``initial_topic`` (the first of them unless given, ``__none`` for none), ``lazy``.
    """

    def __init__(self, **kwargs: Any) -> None:
        from topic_tools_interfaces.srv import MuxAdd, MuxDelete, MuxList, MuxSelect

        super().__init__("mux", "input_topics", (MuxAdd, MuxDelete, MuxList, MuxSelect), **kwargs)
        output = str(self.declare_parameter("output_topic", "~/selected_topic").value)
        lazy = bool(self.declare_parameter("lazy", False).value)
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


if __name__ == "__main__":
    sys.exit(main())
