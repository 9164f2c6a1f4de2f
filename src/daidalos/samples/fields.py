"""Fields that many messages share, from and to numbers and arrays."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from daidalos.samples.sensors import Sample


def time_message(stamp_ns: int) -> Any:
    """Return nanoseconds as a ``builtin_interfaces/msg/Time``."""
    from builtin_interfaces.msg import Time

    seconds, nanoseconds = divmod(int(stamp_ns), 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


def nanoseconds(stamp: Any) -> int:
    """Return a ``builtin_interfaces/msg/Time`` or ``Duration`` as nanoseconds."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def seconds(stamp: Any) -> float:
    """Return a ``builtin_interfaces/msg/Time`` or ``Duration`` as seconds."""
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def duration_message(value: float) -> Any:
    """Return seconds as a ``builtin_interfaces/msg/Duration``."""
    from builtin_interfaces.msg import Duration

    whole, nanosec = divmod(round(value * 1e9), 1_000_000_000)
    return Duration(sec=whole, nanosec=nanosec)


def header(sample: Sample) -> Any:
    """Return the stamp and frame of a sample as a ``std_msgs/msg/Header``."""
    from std_msgs.msg import Header

    return Header(stamp=time_message(sample.stamp_ns), frame_id=sample.frame_id)


def vector(values: Any) -> Any:
    """Return an array (3,) as a ``geometry_msgs/msg/Vector3``."""
    from geometry_msgs.msg import Vector3

    x, y, z = values.tolist()
    return Vector3(x=x, y=y, z=z)


def floats(values: Any) -> array[float]:
    """Return numbers as a message's field of 32 bit floats."""
    result = array("f")
    result.frombytes(np.ascontiguousarray(values, dtype=np.float32).tobytes())
    return result


def array_bytes(values: Any) -> array[int]:
    """Return the memory of an array as a message's field of bytes."""
    result = array("B")
    result.frombytes(np.ascontiguousarray(values).data.cast("B"))
    return result
