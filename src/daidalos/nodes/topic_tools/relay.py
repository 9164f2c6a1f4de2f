"""`relay`: republishes a topic under another name."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


class RelayNode(Tool):
    """Node that forwards every message."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("relay", **kwargs)


def main() -> int:
    """Run the node."""
    return run_tool(RelayNode, "relay <intopic> [outtopic]", lambda words: topics(*words))
