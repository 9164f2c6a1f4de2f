"""Transforming point clouds."""

from __future__ import annotations

from typing import Any

import numpy as np
import tf2_ros
from geometry_msgs.msg import Transform, TransformStamped
from numpy.typing import ArrayLike, NDArray
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import view_points
from std_msgs.msg import Header
from tf2_geometry_msgs.tf2_geometry_msgs import _motion

from daidalos.common.pose3 import rotation_matrix


def to_msg_msg(msg: Any) -> Any:
    """Return a message as a message: itself."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return a message from a message: itself."""
    return msg


def transform_points(point_cloud: ArrayLike, transform: Transform | TransformStamped) -> NDArray[Any]:
    """Return transformed points.

    Parameters
    ----------
    point_cloud : array of shape (n, 3)
    transform
        What to do to them.

    Returns
    -------
    array of shape (n, 3)
    """
    if isinstance(transform, TransformStamped):
        transform = transform.transform
    motion = _motion(transform)
    moved: NDArray[Any] = np.asarray(point_cloud) @ rotation_matrix(motion[3:]).T + np.array(motion[:3])
    return moved


def do_transform_cloud(cloud: PointCloud2, transform: Transform | TransformStamped) -> PointCloud2:
    """Return a cloud with its x, y and z transformed; everything else is kept.

    Parameters
    ----------
    cloud
        It must have the fields x, y and z.
    transform
        A stamped one also names the frame of the result.

    Raises
    ------
    AssertionError
        When a field is missing.
    """
    names = {field.name for field in cloud.fields}
    if not names >= {"x", "y", "z"}:
        raise AssertionError("Point cloud needs the fields x, y, and z for the transformation")
    frame = transform.header.frame_id if isinstance(transform, TransformStamped) else cloud.header.frame_id
    result = PointCloud2(
        header=Header(stamp=cloud.header.stamp, frame_id=frame),
        height=cloud.height,
        width=cloud.width,
        fields=cloud.fields,
        is_bigendian=cloud.is_bigendian,
        point_step=cloud.point_step,
        row_step=cloud.row_step,
        data=cloud.data[:],
        is_dense=cloud.is_dense,
    )
    points = view_points(result)
    moved = transform_points(np.stack([points[name] for name in "xyz"], axis=-1).reshape(-1, 3), transform)
    for axis, name in enumerate("xyz"):
        points[name] = moved[:, axis].reshape(points.shape)
    return result


tf2_ros.TransformRegistration().add(PointCloud2, do_transform_cloud)
tf2_ros.ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
tf2_ros.ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
