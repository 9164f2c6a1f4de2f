"""`drop`: drops some of every few messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


@dataclass(frozen=True)
class DropParameters(Parameters):
    """Parameters of ``drop``, beside those of all tools."""

    x: int = parameter(0, "How many messages to drop.", minimum=0)
    y: int = parameter(0, "Of how many messages.", above=0)

    def check(self) -> None:
        """Refuse to drop more messages than there are."""
        if self.x > self.y:
            raise ParameterError("x", f"must be at most 'y', got x = {self.x} and y = {self.y}")


class DropNode(Tool):
    """Node that drops the first ``x`` of every ``y`` messages."""

    def __init__(self, **kwargs: Any) -> None:
        self._count = 0
        super().__init__("drop", **kwargs)
        self._settings = declare(self, DropParameters)

    def receive(self, content: bytes) -> None:
        """Forward a message or drop it, by its number."""
        if self._count >= self._settings.x:
            self.passage.publish(content)
        self._count = (self._count + 1) % self._settings.y


def _read(words: Sequence[str]) -> dict[str, Any]:
    return topics(words[0], *words[3:]) | {"x": int(words[1]), "y": int(words[2])}


def main() -> int:
    """Run the node."""
    return run_tool(DropNode, "drop <intopic> <X> <Y> [outtopic]", _read)
