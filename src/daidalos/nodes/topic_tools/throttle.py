"""`throttle`: limits the messages, or bytes, per second."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


@dataclass(frozen=True)
class ThrottleParameters(Parameters):
    """Parameters of ``throttle``, beside those of all tools."""

    throttle_type: str = parameter("messages", "What is limited.", choices=("messages", "bytes"))
    msgs_per_sec: float = parameter(1.0, "Highest rate of messages.", unit="1/s", above=0.0)
    bytes_per_sec: int = parameter(0, "Highest rate of bytes; above 0 where they are limited.", unit="B/s", minimum=0)
    window: float = parameter(1.0, "Time over which bytes are counted.", unit="s", above=0.0)
    use_wall_clock: bool = parameter(False, "Whether to count in real time, whatever the node's clock is.")

    def check(self) -> None:
        """Refuse a limit of no bytes."""
        if self.throttle_type == "bytes" and self.bytes_per_sec == 0:
            raise ParameterError("bytes_per_sec", "must be above 0, got 0")


class ThrottleNode(Tool):
    """Node that limits the rate of a topic."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("throttle", **kwargs)
        settings = declare(self, ThrottleParameters)
        self._rate = settings.msgs_per_sec
        self._max_bytes_per_s = settings.bytes_per_sec
        self._window_s = settings.window
        self._time = Clock(clock_type=ClockType.STEADY_TIME) if settings.use_wall_clock else self.get_clock()
        self._last_ns = 0
        self._sent: deque[tuple[int, int]] = deque()
        self._lets_through = self._is_due if settings.throttle_type == "messages" else self._is_within

    def receive(self, content: bytes) -> None:
        """Forward a message unless the limit is reached."""
        if self._lets_through(self._time.now().nanoseconds, len(content)):
            self.passage.publish(content)

    def _is_due(self, now_ns: int, size: int) -> bool:
        if now_ns < self._last_ns:
            self.get_logger().warning("Detected jump back in time, resetting throttle period to now.")
            self._last_ns = 0
        if self._last_ns and now_ns - self._last_ns < 1e9 / self._rate:
            return False
        # By periods, so that the rate holds on average though messages come when they like.
        period = round(1e9 / self._rate)
        self._last_ns = self._last_ns + period if self._last_ns > 0 and now_ns - self._last_ns < 2 * period else now_ns
        return True

    def _is_within(self, now_ns: int, size: int) -> bool:
        while self._sent and self._sent[0][0] < now_ns - self._window_s * 1e9:
            self._sent.popleft()
        if (sum(sent for _, sent in self._sent) + size) / self._window_s > self._max_bytes_per_s:
            return False
        self._sent.append((now_ns, size))
        return True


def _read(words: Sequence[str]) -> dict[str, Any]:
    kind = words[0]
    if kind == "messages":
        return topics(words[1], *words[3:]) | {"throttle_type": kind, "msgs_per_sec": float(words[2])}
    if kind == "bytes":
        limits = {"bytes_per_sec": int(words[2]), "window": float(words[3])}
        return topics(words[1], *words[4:]) | {"throttle_type": kind} | limits
    raise ValueError(kind)


def main() -> int:
    """Run the node."""
    usage = (
        "throttle messages <intopic> <msgs_per_sec> [outtopic]\n"
        "       throttle bytes <intopic> <bytes_per_sec> <window> [outtopic]"
    )
    return run_tool(ThrottleNode, usage, _read)
