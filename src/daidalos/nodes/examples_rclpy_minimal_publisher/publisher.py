"""Publisher on ``topic`` at 2 Hz."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import HelloTalker
from daidalos.nodes.runner import run


class MinimalPublisher(HelloTalker):
    """Node that publishes a sentence every half second."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("minimal_publisher", "topic", 0.5, 'Publishing: "{}"', **kwargs)


def main() -> int:
    """Run the node."""
    return run(MinimalPublisher)
