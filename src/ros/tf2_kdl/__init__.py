"""Transforms of PyKDL's vectors, frames, twists and wrenches, registered by importing this package."""

from __future__ import annotations

from typing import Any

import tf2_ros
from geometry_msgs.msg import PointStamped, TransformStamped
from PyKDL import Frame, Rotation, Twist, Vector, Wrench


def transform_to_kdl(t: TransformStamped) -> Frame:
    """Return a transform as a frame."""
    rotation, translation = t.transform.rotation, t.transform.translation
    return Frame(
        Rotation.Quaternion(rotation.x, rotation.y, rotation.z, rotation.w),
        Vector(translation.x, translation.y, translation.z),
    )


def _transformed(what: Any, transform: TransformStamped) -> Any:
    result = transform_to_kdl(transform) * what
    result.header = transform.header
    return result


def do_transform_vector(vector: Vector, transform: TransformStamped) -> Vector:
    """Return a point transformed, with the header of the transform."""
    result: Vector = _transformed(vector, transform)
    return result


def do_transform_frame(frame: Frame, transform: TransformStamped) -> Frame:
    """Return a frame transformed, with the header of the transform."""
    result: Frame = _transformed(frame, transform)
    return result


def do_transform_twist(twist: Twist, transform: TransformStamped) -> Twist:
    """Return a twist transformed, with the header of the transform."""
    result: Twist = _transformed(twist, transform)
    return result


def do_transform_wrench(wrench: Wrench, transform: TransformStamped) -> Wrench:
    """Return a wrench transformed, with the header of the transform."""
    result: Wrench = _transformed(wrench, transform)
    return result


def to_msg_vector(vector: Vector) -> PointStamped:
    """Return a stamped point as a message."""
    message = PointStamped(header=vector.header)
    message.point.x, message.point.y, message.point.z = vector
    return message


def from_msg_vector(msg: PointStamped) -> Vector:
    """Return the stamped point of a message."""
    return convert_vector(msg, Vector(msg.point.x, msg.point.y, msg.point.z))


def convert_vector(vector: Any, copied: Vector | None = None) -> Vector:
    """Return a copy of a stamped point."""
    result = copied or Vector(vector)
    result.header = vector.header
    return result


for _kind, _transform in (
    (Vector, do_transform_vector),
    (Frame, do_transform_frame),
    (Twist, do_transform_twist),
    (Wrench, do_transform_wrench),
):
    tf2_ros.TransformRegistration().add(_kind, _transform)
tf2_ros.ConvertRegistration().add_to_msg(Vector, to_msg_vector)
tf2_ros.ConvertRegistration().add_from_msg(Vector, from_msg_vector)
tf2_ros.ConvertRegistration().add_convert((Vector, Vector), convert_vector)
