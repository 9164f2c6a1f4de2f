"""Transforms as messages and as tuples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._rigid import Rigid
from ._times import time_ns

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped


def read(transform: Any) -> tuple[int, str, str, Rigid]:
    """Return the stamp in nanoseconds, the parent, the child and the motion of a message."""
    try:
        # A message's slots are a third faster to read than its properties, and /tf is the busiest of topics.
        header = transform._header
        stamp = header._stamp
        translation, rotation = transform._transform._translation, transform._transform._rotation
        return (
            stamp._sec * 1_000_000_000 + stamp._nanosec,
            header._frame_id,
            transform._child_frame_id,
            (
                translation._x,
                translation._y,
                translation._z,
                rotation._x,
                rotation._y,
                rotation._z,
                rotation._w,
            ),
        )
    except AttributeError:
        return _read_any(transform)


def _read_any(transform: Any) -> tuple[int, str, str, Rigid]:
    """Read anything that has the fields of the message."""
    header, moved = transform.header, transform.transform
    parent, child = header.frame_id, transform.child_frame_id
    for frame in (parent, child):
        check_name(frame)
    translation, rotation = moved.translation, moved.rotation
    try:
        motion = (
            float(translation.x),
            float(translation.y),
            float(translation.z),
            float(rotation.x),
            float(rotation.y),
            float(rotation.z),
            float(rotation.w),
        )
    except AttributeError:
        raise TypeError("transform.translation must have x, y, z, and transform.rotation x, y, z, w") from None
    return time_ns(header.stamp), parent, child, motion


def message(stamp: int, target: str, source: str, motion: Rigid) -> TransformStamped:
    """Return the message of a motion from the source frame to the target frame."""
    from builtin_interfaces.msg import Time
    from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
    from std_msgs.msg import Header

    x, y, z, a, b, c, d = motion
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return TransformStamped(
        header=Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=target),
        child_frame_id=source,
        transform=Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=a, y=b, z=c, w=d)),
    )


def check_name(frame: object) -> None:
    """Check that a text can be the name of a frame.

    Raises
    ------
    TypeError
        When it is not a str.
    """
    if not isinstance(frame, str):
        raise TypeError(f"a frame's name must be a str, not {type(frame).__name__}")
