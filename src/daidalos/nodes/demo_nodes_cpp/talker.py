"""`talker`: publishes on ``chatter``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import HelloTalker
from daidalos.nodes.runner import run


class Talker(HelloTalker):
    """Node that publishes a sentence every second."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("talker", "chatter", 1.0, "Publishing: '{}'", first=1, **kwargs)


def main() -> int:
    """Run the node."""
    return run(Talker)
