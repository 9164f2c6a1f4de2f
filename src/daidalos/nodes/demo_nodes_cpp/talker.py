"""`talker`: publishes on ``chatter``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import HelloTalker


class Talker(HelloTalker):
    """Node that publishes a sentence every second."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("talker", "chatter", 1.0, "Publishing: '{}'", first=1, **kwargs)
