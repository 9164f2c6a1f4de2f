"""`listener`: subscribes to ``chatter``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import HelloListener


class Listener(HelloListener):
    """Logs each sentence."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("listener", "chatter", "I heard: [{}]", **kwargs)
