"""Publishers of nodes for asyncio."""

from __future__ import annotations

from typing import Any

from rclpy.publisher import Publisher


class AsyncPublisher(Publisher):
    """Publisher of messages on a topic; made by `AsyncNode.create_publisher`."""

    def publish(self, msg: Any) -> None:
        """Send a message, or one already serialized as bytes.

        Raises
        ------
        RuntimeError
            After `destroy`.
        TypeError
            When `msg` is neither of the topic's type nor bytes.
        """
        if self.handle.is_destroyed:
            raise RuntimeError(f"the publisher on '{self.topic}' was destroyed")
        super().publish(msg)
