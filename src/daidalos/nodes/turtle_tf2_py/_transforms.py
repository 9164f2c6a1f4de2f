"""Transforms as the demonstration publishes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def transform(stamp: Any, parent: str, child: str, position: Sequence[float], rpy: Sequence[float] = (0, 0, 0)) -> Any:
    """Return a ``geometry_msgs/msg/TransformStamped`` of a position [m] and roll, pitch, yaw [rad]."""
    from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
    from std_msgs.msg import Header
    from tf_transformations import quaternion_from_euler

    x, y, z = map(float, position)
    roll, pitch, yaw = map(float, rpy)
    qx, qy, qz, qw = map(float, quaternion_from_euler(roll, pitch, yaw))
    return TransformStamped(
        header=Header(stamp=stamp, frame_id=parent),
        child_frame_id=child,
        transform=Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)),
    )
