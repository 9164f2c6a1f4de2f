"""`delay`: republishes a topic after a delay."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


@dataclass(frozen=True)
class DelayParameters(Parameters):
    """Parameters of ``delay``, beside those of all tools."""

    delay: float = parameter(0.0, "How much later messages are republished.", unit="s", minimum=0.0)
    use_wall_clock: bool = parameter(False, "Whether to wait in real time, whatever the node's clock is.")


class DelayNode(Tool):
    """Node that republishes messages after a delay."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("delay", **kwargs)
        settings = declare(self, DelayParameters)
        self._delay_s = settings.delay
        self._time = Clock(clock_type=ClockType.STEADY_TIME) if settings.use_wall_clock else self.get_clock()
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
