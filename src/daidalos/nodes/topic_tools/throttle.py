"""`throttle`: limits the messages, or bytes, per second."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Sequence
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType

from daidalos.nodes.topic_tools._tool import Tool, run_tool, topics


class ThrottleNode(Tool):
    """Limits a topic.

    Parameters of the node: ``throttle_type`` (``messages`` or ``bytes``), ``msgs_per_sec``, ``bytes_per_sec``,
    ``window`` [s], ``use_wall_clock``.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("throttle", **kwargs)
        kind = str(self.declare_parameter("throttle_type", "messages").value)
        self._rate = float(self.declare_parameter("msgs_per_sec", 1.0).value or 0.0)
        self._max_bytes_per_s = int(self.declare_parameter("bytes_per_sec", 0).value or 0)
        self._window_s = float(self.declare_parameter("window", 1.0).value or 0.0)
        wall = bool(self.declare_parameter("use_wall_clock", False).value)
        self._time = Clock(clock_type=ClockType.STEADY_TIME) if wall else self.get_clock()
        self._last_ns = 0
        self._sent: deque[tuple[int, int]] = deque()
        if kind not in ("messages", "bytes"):
            raise RuntimeError(f"throttle_type must be 'messages' or 'bytes', not '{kind}'")
        if kind == "messages" and self._rate <= 0.0:
            raise RuntimeError("msgs_per_sec must be above zero")
        if kind == "bytes" and (self._max_bytes_per_s <= 0 or self._window_s <= 0.0):
            raise RuntimeError("bytes_per_sec and window must be above zero")
        self._lets_through = self._is_due if kind == "messages" else self._is_within

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


if __name__ == "__main__":
    sys.exit(main())
