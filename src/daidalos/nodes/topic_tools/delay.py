"""`delay`: republishes a topic after a delay."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Sequence
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


class DelayNode(Tool):
    """Node that republishes messages ``delay`` seconds later (parameter, as is ``use_wall_clock``)."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("delay", **kwargs)
        self._delay_s = float(self.declare_parameter("delay", 0.0).value or 0.0)
        wall = bool(self.declare_parameter("use_wall_clock", False).value)
        if self._delay_s < 0.0:
            raise RuntimeError("delay must not be below zero")
        self._time = Clock(clock_type=ClockType.STEADY_TIME) if wall else self.get_clock()
        self._waiting: deque[bytes] = deque()

    def receive(self, content: bytes) -> None:
        """Queue a message until its time."""
        if self._delay_s == 0.0:
            self.passage.publish(content)
            return
        self._waiting.append(content)

        def release() -> None:
            self.destroy_timer(timer)
            self.passage.publish(self._waiting.popleft())

        timer = self.create_timer(self._delay_s, release, clock=self._time)


def _read(words: Sequence[str]) -> dict[str, Any]:
    return topics(words[0], *words[2:]) | {"delay": float(words[1])}


def main() -> int:
    """Run the node."""
    return run_tool(DelayNode, "delay <intopic> <delay> [outtopic]", _read)


if __name__ == "__main__":
    sys.exit(main())
