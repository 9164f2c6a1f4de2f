"""Making transforms for tests, and what they mean according to scipy."""

import math
from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from hypothesis import strategies as st
from numpy.typing import NDArray
from rclpy.time import Time as RosTime
from scipy.spatial.transform import Rotation
from std_msgs.msg import Header
from tf2_py import BufferCore

SECOND = 1_000_000_000
LATEST = RosTime()
"""What asks for the newest transform."""
Numbers = Sequence[float]

coordinates = st.floats(-10.0, 10.0)
vectors = st.tuples(coordinates, coordinates, coordinates)


def _unit(parts: tuple[float, ...]) -> tuple[float, ...]:
    values = np.array(parts)
    return tuple((values / np.linalg.norm(values)).tolist())


quaternions = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda parts: np.linalg.norm(parts) > 0.1).map(_unit)


def stamp(nanoseconds: int) -> Time:
    return Time(sec=nanoseconds // SECOND, nanosec=nanoseconds % SECOND)


def transform(
    parent: str,
    child: str,
    nanoseconds: int = 0,
    xyz: Numbers = (0.0, 0.0, 0.0),
    xyzw: Numbers = (0.0, 0.0, 0.0, 1.0),
) -> TransformStamped:
    return TransformStamped(
        header=Header(stamp=stamp(nanoseconds), frame_id=parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(**dict(zip("xyz", map(float, xyz), strict=True))),
            rotation=Quaternion(**dict(zip("xyzw", map(float, xyzw), strict=True))),
        ),
    )


def translation(message: TransformStamped) -> list[float]:
    vector = message.transform.translation
    return [vector.x, vector.y, vector.z]


def quaternion(message: TransformStamped) -> list[float]:
    rotation = message.transform.rotation
    return [rotation.x, rotation.y, rotation.z, rotation.w]


def matrix(xyz: Numbers, xyzw: Numbers) -> NDArray[np.float64]:
    result = np.eye(4)
    result[:3, :3] = Rotation.from_quat(xyzw).as_matrix()
    result[:3, 3] = xyz
    return result


def matrix_of(message: TransformStamped) -> NDArray[np.float64]:
    return matrix(translation(message), quaternion(message))


def at(seconds: float) -> RosTime:
    """Return a time."""
    return RosTime(nanoseconds=round(seconds * SECOND))


def quarter_turn() -> tuple[float, float, float, float]:
    """Return the quaternion of a quarter turn to the left."""
    return (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))


def filled() -> BufferCore:
    buffer = BufferCore()
    for time in (1, 2):
        buffer.set_transform(transform("a", "b", time * SECOND), "me")
    buffer.set_transform(transform("b", "once", SECOND), "me")
    buffer.set_transform_static(transform("x", "y"), "me")
    return buffer
