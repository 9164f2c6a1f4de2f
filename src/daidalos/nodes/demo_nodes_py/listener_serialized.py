"""`listener_serialized`: subscribes to the serialized messages on ``chatter``."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.hello_world import HelloListener


class ListenerSerialized(HelloListener):
    """Logs each message as its bytes."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("serialized_subscriber", "chatter", 'I heard: "{}"', raw=True, **kwargs)
