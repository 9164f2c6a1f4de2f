"""Values that a stranger may put into goals and requests: numbers that are none, huge ones, texts of every kind."""

from __future__ import annotations

import math
import random
from typing import Any

NUMBERS = (0.0, 1.0, -3.5, math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, 1e9)
TEXTS = (
    "",
    "map",
    "odom",
    "/",
    "..",
    "a\0b",
    "\0",
    "/dev/null",
    "/proc/self/mem",
    "~",
    "x" * 5000,
    "é\u2028",
    "%s{}",
    " ",
)


def hostile_pose(source: random.Random, stamped: Any) -> Any:
    """Fill a PoseStamped with such values; return it."""
    stamped.header.frame_id = source.choice(TEXTS)
    stamped.header.stamp.sec = source.choice((0, -(2**31), 2**31 - 1))
    stamped.header.stamp.nanosec = source.choice((0, 2**32 - 1))
    for part, names in ((stamped.pose.position, "xyz"), (stamped.pose.orientation, "xyzw")):
        for name in names:
            setattr(part, name, source.choice(NUMBERS))
    return stamped
