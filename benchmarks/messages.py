"""The messages that benchmarks send: those by which the figures of ROS 2's own rclpy were taken."""

from __future__ import annotations

import array
from collections.abc import Callable
from typing import Any


def _string() -> Any:
    from std_msgs.msg import String

    return String(data="x" * 64)


def _joint_state() -> Any:
    from sensor_msgs.msg import JointState

    values = [0.1 * number for number in range(20)]
    names = [f"joint_{number}" for number in range(20)]
    return JointState(name=names, position=values, velocity=values, effort=values)


def _laser_scan() -> Any:
    from sensor_msgs.msg import LaserScan

    return LaserScan(range_max=30.0, ranges=[0.01 * number for number in range(720)])


def _image() -> Any:
    from sensor_msgs.msg import Image

    return Image(height=480, width=640, encoding="rgb8", step=1920, data=array.array("B", bytes(921600)))


def _odometry() -> Any:
    from nav_msgs.msg import Odometry

    message = Odometry(child_frame_id="base_link")
    message.header.frame_id = "odom"
    return message


def _tf_message() -> Any:
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    return TFMessage(transforms=[TransformStamped(child_frame_id=f"link_{number}") for number in range(20)])


def _point_cloud() -> Any:
    from sensor_msgs.msg import PointCloud2, PointField

    fields = [PointField(name=name, offset=4 * place, datatype=7, count=1) for place, name in enumerate("xyzi")]
    data = array.array("B", bytes(1048576))
    return PointCloud2(height=1, width=65536, point_step=16, row_step=1048576, fields=fields, data=data)


MESSAGES: dict[str, Callable[[], Any]] = {
    "String": _string,
    "JointState": _joint_state,
    "LaserScan": _laser_scan,
    "Image": _image,
    "Odometry": _odometry,
    "TFMessage": _tf_message,
    "PointCloud2": _point_cloud,
}
