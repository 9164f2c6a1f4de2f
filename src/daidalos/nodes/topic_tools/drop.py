"""`drop`: drops some of every few messages."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


class DropNode(Tool):
    """Node that drops the first ``x`` of every ``y`` messages (parameters of the node)."""

    def __init__(self, **kwargs: Any) -> None:
        self._count = 0
        super().__init__("drop", **kwargs)
        self._x = int(self.declare_parameter("x", 0).value or 0)
        self._y = int(self.declare_parameter("y", 0).value or 0)
        if not 0 <= self._x <= self._y or self._y == 0:
            raise RuntimeError(f"drop needs 0 <= x <= y and y > 0, not x = {self._x} and y = {self._y}")

    def receive(self, content: bytes) -> None:
        """Forward a message or drop it, by its number."""
        if self._count >= self._x:
            self.passage.publish(content)
        self._count = (self._count + 1) % self._y


def _read(words: Sequence[str]) -> dict[str, Any]:
    return topics(words[0], *words[3:]) | {"x": int(words[1]), "y": int(words[2])}


def main() -> int:
    """Run the node."""
    return run_tool(DropNode, "drop <intopic> <X> <Y> [outtopic]", _read)


if __name__ == "__main__":
    sys.exit(main())
