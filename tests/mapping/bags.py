"""Small bags with a robot's scans and odometry, written by an independent library."""

from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from .worlds import Lidar, arena, drive, wheel_odometry

STORE = get_typestore(Stores.ROS2_JAZZY)
MOUNT = (0.2, -0.05, 0.1)


def type_of(name: str) -> Any:
    return STORE.types[name]


def header(stamp_ns: int, frame: str) -> Any:
    time = type_of("builtin_interfaces/msg/Time")(sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return type_of("std_msgs/msg/Header")(stamp=time, frame_id=frame)


def transform(stamp_ns: int, parent: str, child: str, pose: Any) -> Any:
    geometry = "geometry_msgs/msg/"
    return type_of(geometry + "TransformStamped")(
        header=header(stamp_ns, parent),
        child_frame_id=child,
        transform=type_of(geometry + "Transform")(
            translation=type_of(geometry + "Vector3")(x=float(pose[0]), y=float(pose[1]), z=0.0),
            rotation=quaternion(float(pose[2])),
        ),
    )


def quaternion(yaw: float) -> Any:
    return type_of("geometry_msgs/msg/Quaternion")(x=0.0, y=0.0, z=np.sin(yaw / 2), w=np.cos(yaw / 2))


def scan_message(stamp_ns: int, ranges: np.ndarray, lidar: Lidar) -> Any:
    return type_of("sensor_msgs/msg/LaserScan")(
        header=header(stamp_ns, "laser"),
        angle_min=-lidar.field / 2,
        angle_max=lidar.field / 2,
        angle_increment=lidar.increment,
        time_increment=0.0,
        scan_time=0.2,
        range_min=0.05,
        range_max=25.0,
        ranges=ranges.astype(np.float32),
        intensities=np.zeros(0, np.float32),
    )


def odometry_message(stamp_ns: int, pose: np.ndarray) -> Any:
    geometry = "geometry_msgs/msg/"
    vector = type_of(geometry + "Vector3")
    return type_of("nav_msgs/msg/Odometry")(
        header=header(stamp_ns, "odom"),
        child_frame_id="base_link",
        pose=type_of(geometry + "PoseWithCovariance")(
            pose=type_of(geometry + "Pose")(
                position=type_of(geometry + "Point")(x=float(pose[0]), y=float(pose[1]), z=0.0),
                orientation=quaternion(float(pose[2])),
            ),
            covariance=np.zeros(36),
        ),
        twist=type_of(geometry + "TwistWithCovariance")(
            twist=type_of(geometry + "Twist")(linear=vector(x=0.0, y=0.0, z=0.0), angular=vector(x=0.0, y=0.0, z=0.0)),
            covariance=np.zeros(36),
        ),
    )


def write_bag(
    path: Path,
    *,
    storage: StoragePlugin = StoragePlugin.MCAP,
    scan_topics: tuple[str, ...] = ("/scan",),
    odometry: bool = True,
    moving_transforms: bool = False,
    mounted: bool = True,
) -> np.ndarray:
    """Write a bag of a short drive through the arena and return the true poses; odometry runs at twice the rate."""
    rng = np.random.default_rng(11)
    lidar = Lidar(beams=180, pose=MOUNT)
    way = np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [0.0, 2.4]])
    true = drive(way, rate=10.0)
    odom = wheel_odometry(true, rng, scale=0.02, noise=0.05)
    with Writer(path, version=9, storage_plugin=storage) as bag:
        tf = bag.add_connection("/tf", "tf2_msgs/msg/TFMessage", typestore=STORE)
        static = bag.add_connection("/tf_static", "tf2_msgs/msg/TFMessage", typestore=STORE)
        odom_connection = bag.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=STORE) if odometry else None
        scans = [bag.add_connection(t, "sensor_msgs/msg/LaserScan", typestore=STORE) for t in scan_topics]
        if mounted:
            message = type_of("tf2_msgs/msg/TFMessage")(
                transforms=[transform(0, "base_link", "mast", (0.0, 0.0, 0.0)), transform(0, "mast", "laser", MOUNT)]
            )
            put(bag, static, 10**9, message)
        for k, (pose, believed) in enumerate(zip(true, odom, strict=True)):
            stamp = 10**9 + k * 10**8
            if odom_connection:
                put(bag, odom_connection, stamp, odometry_message(stamp, believed))
            if moving_transforms:
                message = type_of("tf2_msgs/msg/TFMessage")(
                    transforms=[transform(stamp, "odom", "base_link", believed)]
                )
                put(bag, tf, stamp, message)
            if k % 2 == 0:
                ranges = np.asarray(lidar.scan(arena(), pose, rng).ranges)
                for connection in scans:
                    put(bag, connection, stamp, scan_message(stamp, ranges, lidar))
    return true[::2]


def put(bag: Writer, connection: Any, stamp_ns: int, message: Any) -> None:
    bag.write(connection, stamp_ns, STORE.serialize_cdr(message, connection.msgtype))
