"""Transforming points, vectors, poses and what is made of them.

Every function returns a new message in the frame, and with the time, of the transform's header; neither the
message nor the transform given is changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import TYPE_CHECKING, Any

import tf2_ros
from builtin_interfaces.msg import Time
from geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    Polygon,
    PolygonStamped,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    QuaternionStamped,
    Transform,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from std_msgs.msg import Header
from tf2_py._rigid import Rigid, canonical, compose

from daidalos.common.pose3 import rotate, rotation_matrix

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_ROUNDING = 1e-12


def to_msg_msg(msg: Any) -> Any:
    """Return a message as a message: itself."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return a message from a message: itself."""
    return msg


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """Return a transformed point."""
    return PointStamped(header=_header(transform), point=_point(point.point, _motion(transform.transform)))


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """Return a transformed vector: it is turned, but not moved."""
    return Vector3Stamped(header=_header(transform), vector=_vector(vector3.vector, _motion(transform.transform)))


def do_transform_quaternion(quaternion: QuaternionStamped, transform: TransformStamped) -> QuaternionStamped:
    """Return a transformed orientation."""
    turned = _pose(Pose(orientation=quaternion.quaternion), _motion(transform.transform))
    return QuaternionStamped(header=_header(transform), quaternion=turned.orientation)


def do_transform_pose(pose: Pose | PoseStamped, transform: TransformStamped) -> Pose | PoseStamped:
    """Return a transformed pose; as up to Humble, one with a header is welcome as well."""
    if isinstance(pose, PoseStamped):
        return do_transform_pose_stamped(pose, transform)
    return _pose(pose, _motion(transform.transform))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Return a transformed pose."""
    return PoseStamped(header=_header(transform), pose=_pose(pose.pose, _motion(transform.transform)))


def do_transform_pose_array(poses: PoseArray, transform: TransformStamped) -> PoseArray:
    """Return transformed poses."""
    motion = _motion(transform.transform)
    return PoseArray(header=_header(transform), poses=[_pose(pose, motion) for pose in poses.poses])


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Return a transformed pose, its covariance turned along."""
    return PoseWithCovarianceStamped(
        header=_header(transform),
        pose=PoseWithCovariance(
            pose=_pose(pose.pose.pose, _motion(transform.transform)),
            covariance=transform_covariance(pose.pose.covariance, transform),
        ),
    )


def do_transform_polygon_stamped(polygon: PolygonStamped, transform: TransformStamped) -> PolygonStamped:
    """Return a transformed polygon."""
    motion = _motion(transform.transform)
    points = []
    for point in polygon.polygon.points:
        x, y, z = _move(point, motion)
        points.append(Point32(x=x, y=y, z=z))
    return PolygonStamped(header=_header(transform), polygon=Polygon(points=points))


def do_transform_transform(inner: TransformStamped, transform: TransformStamped) -> TransformStamped:
    """Return the transform from the child of `inner` to the frame of `transform`."""
    x, y, z, a, b, c, d = canonical(compose(_motion(transform.transform), _motion(inner.transform)))
    return TransformStamped(
        header=_header(transform),
        child_frame_id=inner.child_frame_id,
        transform=Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=a, y=b, z=c, w=d)),
    )


def do_transform_wrench(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    """Return a wrench along other axes: force and torque are turned, and act at the same point as before."""
    motion = _motion(transform.transform)
    return WrenchStamped(
        header=_header(transform),
        wrench=Wrench(force=_vector(wrench.wrench.force, motion), torque=_vector(wrench.wrench.torque, motion)),
    )


def transform_covariance(cov_in: Sequence[float], transform: TransformStamped) -> NDArray[np.float64]:
    """Return a pose's covariance along other axes.

    Parameters
    ----------
    cov_in
        Row by row, 6 x 6, over x, y, z and the rotations about the axes x, y, z.
    transform
        Whose rotation turns both.

    Returns
    -------
    array of shape (36,)
    """
    import numpy as np

    _, _, _, a, b, c, d = _motion(transform.transform)
    rotation = rotation_matrix((a, b, c, d))
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = rotation
    return (both @ np.asarray(cov_in, dtype=np.float64).reshape(6, 6) @ both.T).ravel()


def _motion(transform: Transform) -> Rigid:
    translation, q = transform.translation, transform.rotation
    return translation.x, translation.y, translation.z, *_unit(q)


def _unit(q: Quaternion) -> tuple[float, float, float, float]:
    """Return a quaternion with length one; no rotation where it has none."""
    a, b, c, d = q.x, q.y, q.z, q.w
    squared = a * a + b * b + c * c + d * d
    if -_ROUNDING < squared - 1.0 < _ROUNDING:
        return a, b, c, d
    if squared < _ROUNDING:
        return 0.0, 0.0, 0.0, 1.0
    length = sqrt(squared)
    return a / length, b / length, c / length, d / length


def _move(point: Any, motion: Rigid) -> tuple[float, float, float]:
    x, y, z = rotate(motion[3:], (point.x, point.y, point.z))
    return x + motion[0], y + motion[1], z + motion[2]


def _point(point: Point, motion: Rigid) -> Point:
    x, y, z = _move(point, motion)
    return Point(x=x, y=y, z=z)


def _vector(vector: Vector3, motion: Rigid) -> Vector3:
    x, y, z = rotate(motion[3:], (vector.x, vector.y, vector.z))
    return Vector3(x=x, y=y, z=z)


def _pose(pose: Pose, motion: Rigid) -> Pose:
    position = pose.position
    inner = (position.x, position.y, position.z, *_unit(pose.orientation))
    x, y, z, a, b, c, d = canonical(compose(motion, inner))
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=a, y=b, z=c, w=d))


def _header(transform: TransformStamped) -> Header:
    header = transform.header
    return Header(stamp=Time(sec=header.stamp.sec, nanosec=header.stamp.nanosec), frame_id=header.frame_id)


for _kind, _do_transform in (
    (PointStamped, do_transform_point),
    (Vector3Stamped, do_transform_vector3),
    (QuaternionStamped, do_transform_quaternion),
    (PoseStamped, do_transform_pose_stamped),
    (PoseArray, do_transform_pose_array),
    (PoseWithCovarianceStamped, do_transform_pose_with_covariance_stamped),
    (PolygonStamped, do_transform_polygon_stamped),
    (TransformStamped, do_transform_transform),
    (WrenchStamped, do_transform_wrench),
):
    tf2_ros.TransformRegistration().add(_kind, _do_transform)
    tf2_ros.ConvertRegistration().add_to_msg(_kind, to_msg_msg)
    tf2_ros.ConvertRegistration().add_from_msg(_kind, from_msg_msg)
