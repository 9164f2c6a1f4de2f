"""Conversion of messages to and from the libraries' arrays: poses, stamps, paths, grids and scans."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.common.pose3 import quaternion_from_yaw, rotation_matrix, yaw_from_quaternion

if TYPE_CHECKING:
    from daidalos.mapping.scan import LaserScanData
    from daidalos.navigation.costmap.observation import CloudData, RangeData

SMALLEST_CELL = 1e-4
"""Least resolution of a map [m] that is used."""


def twist_message(velocity: Any, frame: str | None, stamp: Any) -> Any:
    """Return (x, y, yaw) velocities as a ``Twist``, or a ``TwistStamped`` where a frame is given."""
    from geometry_msgs.msg import Twist, TwistStamped, Vector3
    from std_msgs.msg import Header

    x, y, yaw = (float(value) for value in velocity)
    twist = Twist(linear=Vector3(x=x, y=y, z=0.0), angular=Vector3(x=0.0, y=0.0, z=yaw))
    return twist if frame is None else TwistStamped(header=Header(frame_id=frame, stamp=stamp), twist=twist)


def velocity_of(twist: Any) -> Array:
    """Return the planar velocity (x [m/s], y [m/s], yaw [rad/s]) of a ``geometry_msgs/msg/Twist``."""
    return np.array([twist.linear.x, twist.linear.y, twist.angular.z])


def yaw_of(quaternion: Any) -> float:
    """Return the heading of a ``geometry_msgs/msg/Quaternion`` [rad]."""
    return yaw_from_quaternion((quaternion.x, quaternion.y, quaternion.z, quaternion.w))


def quaternion_message(yaw: float) -> Any:
    """Return a heading [rad] as a ``geometry_msgs/msg/Quaternion``."""
    from geometry_msgs.msg import Quaternion

    x, y, z, w = quaternion_from_yaw(yaw)
    return Quaternion(x=x, y=y, z=z, w=w)


def pose2_of(pose: Any) -> Array:
    """Return (x, y, yaw) of a ``geometry_msgs/msg/Pose``."""
    return np.array([pose.position.x, pose.position.y, yaw_of(pose.orientation)])


def pose2_of_transform(transform: Any) -> Array:
    """Return (x, y, yaw) of a ``geometry_msgs/msg/Transform``."""
    return np.array([transform.translation.x, transform.translation.y, yaw_of(transform.rotation)])


def pose_message(pose: Any) -> Any:
    """Return (x, y, yaw) as a ``geometry_msgs/msg/Pose``."""
    from geometry_msgs.msg import Point, Pose

    x, y, yaw = (float(value) for value in pose)
    return Pose(position=Point(x=x, y=y, z=0.0), orientation=quaternion_message(yaw))


def pose_stamped(pose: Any, frame: str, stamp: Any) -> Any:
    """Return (x, y, yaw) in a frame as a ``geometry_msgs/msg/PoseStamped``."""
    from geometry_msgs.msg import PoseStamped
    from std_msgs.msg import Header

    return PoseStamped(header=Header(frame_id=frame, stamp=stamp), pose=pose_message(pose))


def transform_stamped(pose: Any, frame: str, child: str, stamp: Any) -> Any:
    """Return (x, y, yaw) of `child` in `frame` as a ``geometry_msgs/msg/TransformStamped``."""
    from geometry_msgs.msg import Transform, TransformStamped, Vector3
    from std_msgs.msg import Header

    x, y, yaw = (float(value) for value in pose)
    return TransformStamped(
        header=Header(frame_id=frame, stamp=stamp),
        child_frame_id=child,
        transform=Transform(translation=Vector3(x=x, y=y, z=0.0), rotation=quaternion_message(yaw)),
    )


def path_message(poses: Array, frame: str, stamp: Any) -> Any:
    """Return poses (n, 3) in a frame as a ``nav_msgs/msg/Path``."""
    from nav_msgs.msg import Path
    from std_msgs.msg import Header

    return Path(header=Header(frame_id=frame, stamp=stamp), poses=[pose_stamped(pose, frame, stamp) for pose in poses])


def path_array(path: Any) -> Array:
    """Return the poses (n, 3) of a ``nav_msgs/msg/Path``."""
    return np.array([pose2_of(stamped.pose) for stamped in path.poses]).reshape(-1, 3)


def grid_message(values: NDArray[np.int8], resolution: float, origin: Any, frame: str, stamp: Any) -> Any:
    """Return occupancies as a ``nav_msgs/msg/OccupancyGrid``.

    Parameters
    ----------
    values : array (rows, columns) of int8
        -1 unknown, 0 free to 100 occupied; row 0 is at the origin.
    resolution : float
        Side of a cell [m].
    origin : sequence of 2 floats
        Lower left corner [m].
    frame, stamp
        Of the header.
    """
    from array import array

    from nav_msgs.msg import MapMetaData, OccupancyGrid
    from std_msgs.msg import Header

    data = array("b")
    data.frombytes(np.ascontiguousarray(values, dtype=np.int8).tobytes())
    rows, columns = values.shape
    return OccupancyGrid(
        header=Header(frame_id=frame, stamp=stamp),
        info=MapMetaData(
            map_load_time=stamp,
            resolution=float(resolution),
            width=int(columns),
            height=int(rows),
            origin=pose_message((origin[0], origin[1], 0.0)),
        ),
        data=data,
    )


def grid_array(grid: Any) -> NDArray[np.int8]:
    """Return the occupancies (rows, columns) of a ``nav_msgs/msg/OccupancyGrid``.

    Raises
    ------
    UserError
        When the message does not have as many cells as it says, or no place and size of them.
    """
    info = grid.info
    if len(grid.data) != info.width * info.height:
        raise UserError(f"a map with {len(grid.data)} cells instead of {info.width} x {info.height} is not used")
    if not (SMALLEST_CELL <= info.resolution < math.inf and np.isfinite(pose2_of(info.origin)).all()):
        raise UserError(f"a map with a resolution of {info.resolution:g} m, or without a finite origin, is not used")
    return np.frombuffer(grid.data, dtype=np.int8).reshape(grid.info.height, grid.info.width)


class SensorMount(NamedTuple):
    """Mounting of a sensor on the base.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Pose (x, y, yaw) in the frame of the base.
    tilt : tuple of float
        Roll and pitch [rad], applied before the yaw.
    height : float
        Height [m] over the base.
    """

    pose: Array
    tilt: tuple[float, float]
    height: float = 0.0


def mount_of_transform(transform: Any) -> SensorMount:
    """Return a ``geometry_msgs/msg/Transform`` from the base to a sensor as a mounting."""
    q = transform.rotation
    matrix = rotation_matrix((q.x, q.y, q.z, q.w))
    pitch = float(np.arcsin(np.clip(-matrix[2, 0], -1.0, 1.0)))
    roll = float(np.arctan2(matrix[2, 1], matrix[2, 2]))
    yaw = float(np.arctan2(matrix[1, 0], matrix[0, 0]))
    offset = transform.translation
    return SensorMount(np.array([offset.x, offset.y, yaw]), (roll, pitch), offset.z)


def scan_data(scan: Any, sensor: Array | SensorMount) -> LaserScanData:
    """Return a ``sensor_msgs/msg/LaserScan`` as arrays.

    Parameters
    ----------
    scan
        The message.
    sensor : array (3,) or SensorMount
        Pose (x, y, yaw) of the sensor in the base, or how it is mounted there.
    """
    from daidalos.mapping.scan import LaserScanData

    pose, tilt, height = sensor if isinstance(sensor, SensorMount) else SensorMount(sensor, (0.0, 0.0))
    x, y, yaw = (float(value) for value in pose)
    return LaserScanData(
        ranges=np.frombuffer(scan.ranges, dtype=np.float32),
        angle_min=scan.angle_min,
        angle_increment=scan.angle_increment,
        range_min=scan.range_min,
        range_max=scan.range_max,
        time_increment=scan.time_increment,
        sensor_pose=(x, y, yaw),
        sensor_tilt=tilt,
        sensor_height=height,
    )


def range_data(message: Any, sensor: SensorMount) -> RangeData:
    """Return a ``sensor_msgs/msg/Range`` of a sensor that is mounted so."""
    from daidalos.navigation.costmap.observation import RangeData

    pose = np.asarray(sensor.pose, dtype=np.float64)
    return RangeData(message.range, message.min_range, message.max_range, message.field_of_view, pose)


def cloud_data(cloud: Any, transform: Any) -> CloudData:
    """Return a ``sensor_msgs/msg/PointCloud2`` as arrays in the frame of the base.

    Parameters
    ----------
    cloud
        The message.
    transform
        ``geometry_msgs/msg/Transform`` from the base to the sensor.
    """
    from sensor_msgs_py.point_cloud2 import read_points_numpy

    from daidalos.navigation.costmap.observation import CloudData

    q, offset = transform.rotation, transform.translation
    sensor = np.array([offset.x, offset.y, offset.z])
    points = read_points_numpy(cloud, ["x", "y", "z"]).reshape(-1, 3).astype(np.float64)
    rotation = rotation_matrix((q.x, q.y, q.z, q.w))
    return CloudData(points @ rotation.T + sensor, sensor, rotation)
