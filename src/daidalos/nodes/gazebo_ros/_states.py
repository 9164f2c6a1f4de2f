"""Messages of the simulation's poses, velocities and contacts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, Vector
from daidalos.description.link import Rgba
from daidalos.samples.fields import time_message

if TYPE_CHECKING:
    from daidalos.simulation.contacts import Touch


def pose_message(pose: Pose) -> Any:
    """Return a pose as a ``geometry_msgs/msg/Pose``."""
    from geometry_msgs.msg import Point, Quaternion
    from geometry_msgs.msg import Pose as PoseMessage

    (x, y, z), (qx, qy, qz, qw) = pose.position, pose.orientation
    return PoseMessage(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def pose_of(message: Any) -> Pose:
    """Return a ``geometry_msgs/msg/Pose``; a quaternion of any length will do, and none means no rotation.

    Raises
    ------
    ValueError
        When a number of it is not finite.
    """
    q = message.orientation
    require_finite("an orientation", (q.x, q.y, q.z, q.w))
    length = math.hypot(q.x, q.y, q.z, q.w)
    orientation = (q.x / length, q.y / length, q.z / length, q.w / length) if length else (0.0, 0.0, 0.0, 1.0)
    return Pose(vector_of(message.position), orientation)


def twist_message(linear: Array, angular: Array) -> Any:
    """Return velocities [m/s, rad/s] as a ``geometry_msgs/msg/Twist``."""
    from geometry_msgs.msg import Twist, Vector3

    return Twist(linear=_vector(Vector3, linear), angular=_vector(Vector3, angular))


def _vector(kind: Any, values: Array) -> Any:
    x, y, z = values.tolist()
    return kind(x=x, y=y, z=z)


def vector_of(message: Any) -> Vector:
    """Return a ``geometry_msgs/msg/Vector3`` or ``Point``.

    Raises
    ------
    ValueError
        When a number of it is not finite.
    """
    vector = float(message.x), float(message.y), float(message.z)
    require_finite("a vector", vector)
    return vector


def require_finite(what: str, values: Iterable[float]) -> None:
    """Refuse numbers that are not finite: one of them would spread through the whole simulation.

    Raises
    ------
    ValueError
    """
    values = tuple(values)
    if not all(math.isfinite(value) for value in values):
        raise ValueError(f"{what} has numbers that are not finite: {', '.join(f'{value:g}' for value in values)}")


def color_message(color: Rgba) -> Any:
    """Return red, green, blue, alpha as a ``std_msgs/msg/ColorRGBA``."""
    from std_msgs.msg import ColorRGBA

    r, g, b, a = color
    return ColorRGBA(r=r, g=g, b=b, a=a)


def color_of(message: Any) -> Rgba:
    """Return a ``std_msgs/msg/ColorRGBA``."""
    return float(message.r), float(message.g), float(message.b), float(message.a)


def contacts_message(touches: Iterable[tuple[str, Touch]], now_ns: int) -> Any:
    """Return what models have touched as a ``gazebo_msgs/msg/ContactsState``."""
    from gazebo_msgs.msg import ContactsState, ContactState
    from std_msgs.msg import Header

    states = [
        ContactState(
            info=f"first at {touch.first_ns * 1e-9:.3f} s, last at {touch.last_ns * 1e-9:.3f} s",
            collision1_name=f"{name}::{touch.link}",
            collision2_name=f"{touch.other_model}::{touch.other_link}",
        )
        for name, touch in touches
    ]
    return ContactsState(header=Header(stamp=time_message(now_ns), frame_id="world"), states=states)
