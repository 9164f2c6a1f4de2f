"""Properties of messages for filters."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.clock_type import ClockType
from rclpy.time import Time

TimeGetter = Callable[[Any], Time | None]


def get_time_from_message_header(message: Any) -> Time | None:
    """Return the stamp in a message's header; None when it has none."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    if stamp is None or hasattr(stamp, "nanoseconds"):
        return stamp
    return Time(seconds=stamp.sec, nanoseconds=stamp.nanosec, clock_type=ClockType.ROS_TIME)


def warn_of_headerless(logger_name: str) -> None:
    """Log that a message without a stamp was dropped."""
    from rclpy.logging import get_logger

    get_logger(logger_name).warning(
        "dropped a message without a stamp; with 'allow_headerless' such messages get the time of their arrival",
        throttle_duration_sec=1.0,
    )
