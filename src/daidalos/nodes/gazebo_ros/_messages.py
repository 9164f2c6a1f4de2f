"""One table: what a simulation says and takes, and the messages for it."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.nodes.conversions import time_message
from daidalos.simulation import samples


@dataclass(frozen=True)
class Outgoing:
    """How a class of samples becomes a message.

    Parameters
    ----------
    message : callable
        Returns the message's class; importing it waits until it is needed.
    convert : callable
        Makes the message.
    """

    message: Callable[[], Any]
    convert: Callable[[Any], Any]


@dataclass(frozen=True)
class Incoming:
    """How a message becomes a command; see `Outgoing`."""

    message: Callable[[], Any]
    convert: Callable[[Any], Any]


def _header(sample: samples.Sample) -> Any:
    from std_msgs.msg import Header

    return Header(stamp=time_message(sample.stamp_ns), frame_id=sample.frame_id)


def _vector(values: Any) -> Any:
    from geometry_msgs.msg import Vector3

    x, y, z = values.tolist()
    return Vector3(x=x, y=y, z=z)


def _quaternion(values: Any) -> Any:
    from geometry_msgs.msg import Quaternion

    x, y, z, w = values.tolist()
    return Quaternion(x=x, y=y, z=z, w=w)


def _floats(values: Any) -> array[float]:
    result = array("f")
    result.frombytes(np.ascontiguousarray(values, dtype=np.float32).tobytes())
    return result


def _scan_type() -> Any:
    from sensor_msgs.msg import LaserScan

    return LaserScan


def _scan(sample: samples.LaserScanSample) -> Any:
    return _scan_type()(
        header=_header(sample),
        angle_min=sample.angle_min,
        angle_max=sample.angle_max,
        angle_increment=sample.angle_increment,
        time_increment=sample.time_increment,
        scan_time=sample.scan_time,
        range_min=sample.range_min,
        range_max=sample.range_max,
        ranges=_floats(sample.ranges),
        intensities=_floats(sample.intensities),
    )


def _imu_type() -> Any:
    from sensor_msgs.msg import Imu

    return Imu


def _imu(sample: samples.ImuSample) -> Any:
    return _imu_type()(
        header=_header(sample),
        orientation=_quaternion(sample.orientation),
        orientation_covariance=sample.orientation_covariance,
        angular_velocity=_vector(sample.angular_velocity),
        angular_velocity_covariance=sample.angular_velocity_covariance,
        linear_acceleration=_vector(sample.linear_acceleration),
        linear_acceleration_covariance=sample.linear_acceleration_covariance,
    )


def _odometry_type() -> Any:
    from nav_msgs.msg import Odometry

    return Odometry


def _odometry(sample: samples.OdometrySample) -> Any:
    from geometry_msgs.msg import Point, Pose, PoseWithCovariance, Twist, TwistWithCovariance

    x, y, z = sample.position.tolist()
    pose = Pose(position=Point(x=x, y=y, z=z), orientation=_quaternion(sample.orientation))
    twist = Twist(linear=_vector(sample.linear), angular=_vector(sample.angular))
    return _odometry_type()(
        header=_header(sample),
        child_frame_id=sample.child_frame_id,
        pose=PoseWithCovariance(pose=pose, covariance=sample.pose_covariance),
        twist=TwistWithCovariance(twist=twist, covariance=sample.twist_covariance),
    )


def _transforms_type() -> Any:
    from tf2_msgs.msg import TFMessage

    return TFMessage


def transform(sample: samples.TransformSample) -> Any:
    """Return a transform as a ``geometry_msgs/msg/TransformStamped``."""
    from geometry_msgs.msg import Transform, TransformStamped

    return TransformStamped(
        header=_header(sample),
        child_frame_id=sample.child_frame_id,
        transform=Transform(translation=_vector(sample.translation), rotation=_quaternion(sample.rotation)),
    )


def _transforms(sample: samples.TransformSample) -> Any:
    return _transforms_type()(transforms=[transform(sample)])


def _joint_state_type() -> Any:
    from sensor_msgs.msg import JointState

    return JointState


def _joint_state(sample: samples.JointStateSample) -> Any:
    return _joint_state_type()(
        header=_header(sample),
        name=list(sample.names),
        position=sample.positions,
        velocity=sample.velocities,
        effort=sample.efforts,
    )


def _image_type() -> Any:
    from sensor_msgs.msg import Image

    return Image


def _image(sample: samples.ImageSample) -> Any:
    pixels = np.ascontiguousarray(sample.pixels)
    return _image_type()(
        header=_header(sample),
        height=pixels.shape[0],
        width=pixels.shape[1],
        encoding=sample.encoding,
        is_bigendian=0,
        step=pixels.strides[0],
        data=_bytes(pixels),
    )


def _bytes(values: Any) -> array[int]:
    result = array("B")
    result.frombytes(memoryview(values).cast("B"))
    return result


def _camera_info_type() -> Any:
    from sensor_msgs.msg import CameraInfo

    return CameraInfo


def _camera_info(sample: samples.CameraInfoSample) -> Any:
    return _camera_info_type()(
        header=_header(sample),
        height=sample.height,
        width=sample.width,
        distortion_model="plumb_bob",
        d=list(sample.distortion),
        k=sample.matrix.ravel(),
        r=np.eye(3).ravel(),
        p=sample.projection.ravel(),
    )


def _points_type() -> Any:
    from sensor_msgs.msg import PointCloud2

    return PointCloud2


def _points(sample: samples.PointCloudSample) -> Any:
    from sensor_msgs.msg import PointField

    rows, columns = sample.points.shape[:2]
    extras = {"intensity": sample.intensities, "rgb": None if sample.colors is None else _packed(sample.colors)}
    bands = {"x": None, "y": None, "z": None} | {name: band for name, band in extras.items() if band is not None}
    buffer = np.empty((rows, columns, len(bands)), dtype=np.float32)
    buffer[:, :, :3] = sample.points
    for place, band in enumerate(bands.values()):
        if band is not None:
            buffer[:, :, place] = band
    fields = [
        PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
        for place, name in enumerate(bands)
    ]
    return _points_type()(
        header=_header(sample),
        height=rows,
        width=columns,
        fields=fields,
        is_bigendian=False,
        point_step=4 * len(bands),
        row_step=4 * len(bands) * columns,
        data=_bytes(buffer),
        is_dense=bool(np.isfinite(sample.points).all()),
    )


def _packed(colors: Any) -> Any:
    """Return colours as PCL packs them: three bytes in the bits of a float."""
    packed = np.zeros((*colors.shape[:2], 4), dtype=np.uint8)
    packed[:, :, :3] = colors[:, :, ::-1]
    return packed.view("<f4")[:, :, 0]


def _logical_type() -> Any:
    from ros_gz_interfaces.msg import LogicalCameraImage

    return LogicalCameraImage


def _logical(sample: samples.LogicalImageSample) -> Any:
    from ros_gz_interfaces.msg import LogicalCameraImageModel

    from daidalos.nodes.gazebo_ros._states import pose_message

    models = [LogicalCameraImageModel(name=name, pose=pose_message(pose)) for name, pose in sample.models]
    return _logical_type()(header=_header(sample), pose=pose_message(sample.pose), model=models)


def _twist_type() -> Any:
    from geometry_msgs.msg import Twist

    return Twist


def _twist(message: Any) -> samples.TwistCommand:
    linear, angular = message.linear, message.angular
    return samples.TwistCommand(np.array([linear.x, linear.y, linear.z]), np.array([angular.x, angular.y, angular.z]))


OUTGOING: dict[type[samples.Sample], Outgoing] = {
    samples.LaserScanSample: Outgoing(_scan_type, _scan),
    samples.PointCloudSample: Outgoing(_points_type, _points),
    samples.ImageSample: Outgoing(_image_type, _image),
    samples.CameraInfoSample: Outgoing(_camera_info_type, _camera_info),
    samples.LogicalImageSample: Outgoing(_logical_type, _logical),
    samples.ImuSample: Outgoing(_imu_type, _imu),
    samples.OdometrySample: Outgoing(_odometry_type, _odometry),
    samples.TransformSample: Outgoing(_transforms_type, _transforms),
    samples.JointStateSample: Outgoing(_joint_state_type, _joint_state),
}
INCOMING: dict[type, Incoming] = {
    samples.TwistCommand: Incoming(_twist_type, _twist),
}
