"""Messages and sources for filters."""

from typing import Any

from geometry_msgs.msg import PointStamped
from message_filters import SimpleFilter
from rclpy.time import Time


class Made:
    """Anything with a header will do."""

    class Header:
        def __init__(self, stamp: Any) -> None:
            self.stamp = stamp

    def __init__(self, stamp: Any, data: Any = None) -> None:
        self.header = Made.Header(stamp)
        self.data = data

    def __repr__(self) -> str:
        return f"Made({self.header.stamp}, {self.data})"


def real(seconds: float, x: float = 0.0) -> PointStamped:
    """A real message."""
    message = PointStamped()
    message.header.stamp = Time(nanoseconds=round(seconds * 1e9)).to_msg()
    message.point.x = x
    return message


def at(seconds: float, data: Any = None) -> Made:
    """A message whose stamp is a time."""
    return Made(Time(nanoseconds=round(seconds * 1e9)), data)


class Output:
    """Collects what a filter puts out."""

    def __init__(self, source: SimpleFilter, *arguments: Any) -> None:
        self.calls: list[tuple[Any, ...]] = []
        source.registerCallback(self, *arguments)

    def __call__(self, *messages: Any) -> None:
        self.calls.append(messages)
