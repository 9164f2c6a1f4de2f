"""One table: what a simulation says and takes, and the messages for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.nodes.conversions import seconds
from daidalos.nodes.gazebo_ros._conversion import Incoming, Outgoing, floats, header, named, quaternion, vector
from daidalos.nodes.gazebo_ros._image_messages import IMAGES
from daidalos.nodes.gazebo_ros._sensor_messages import SENSORS
from daidalos.samples import commands
from daidalos.samples import sensors as samples


def _scan_type() -> Any:
    from sensor_msgs.msg import LaserScan

    return LaserScan


def _scan(sample: samples.LaserScanSample) -> Any:
    return _scan_type()(
        header=header(sample),
        angle_min=sample.angle_min,
        angle_max=sample.angle_max,
        angle_increment=sample.angle_increment,
        time_increment=sample.time_increment,
        scan_time=sample.scan_time,
        range_min=sample.range_min,
        range_max=sample.range_max,
        ranges=floats(sample.ranges),
        intensities=floats(sample.intensities),
    )


def _imu_type() -> Any:
    from sensor_msgs.msg import Imu

    return Imu


def _imu(sample: samples.ImuSample) -> Any:
    return _imu_type()(
        header=header(sample),
        orientation=quaternion(sample.orientation),
        orientation_covariance=sample.orientation_covariance,
        angular_velocity=vector(sample.angular_velocity),
        angular_velocity_covariance=sample.angular_velocity_covariance,
        linear_acceleration=vector(sample.linear_acceleration),
        linear_acceleration_covariance=sample.linear_acceleration_covariance,
    )


def _odometry_type() -> Any:
    from nav_msgs.msg import Odometry

    return Odometry


def _odometry(sample: samples.OdometrySample) -> Any:
    from geometry_msgs.msg import Point, Pose, PoseWithCovariance, Twist, TwistWithCovariance

    x, y, z = sample.position.tolist()
    pose = Pose(position=Point(x=x, y=y, z=z), orientation=quaternion(sample.orientation))
    twist = Twist(linear=vector(sample.linear), angular=vector(sample.angular))
    return _odometry_type()(
        header=header(sample),
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
        header=header(sample),
        child_frame_id=sample.child_frame_id,
        transform=Transform(translation=vector(sample.translation), rotation=quaternion(sample.rotation)),
    )


def _transforms(sample: samples.TransformSample) -> Any:
    return _transforms_type()(transforms=[transform(sample)])


def _joint_state_type() -> Any:
    from sensor_msgs.msg import JointState

    return JointState


def _joint_state(sample: samples.JointStateSample) -> Any:
    return _joint_state_type()(
        header=header(sample),
        name=list(sample.names),
        position=sample.positions,
        velocity=sample.velocities,
        effort=sample.efforts,
    )


def _twist(message: Any) -> commands.TwistCommand:
    linear, angular = message.linear, message.angular
    return commands.TwistCommand(np.array([linear.x, linear.y, linear.z]), np.array([angular.x, angular.y, angular.z]))


_trajectory_type = named("trajectory_msgs", "JointTrajectory")


def _wrench(message: Any) -> commands.WrenchCommand:
    force, torque = message.force, message.torque
    return commands.WrenchCommand(np.array([force.x, force.y, force.z]), np.array([torque.x, torque.y, torque.z]))


def _number(message: Any) -> commands.NumberCommand:
    return commands.NumberCommand(float(message.data))


def trajectory_of(message: Any) -> commands.PositionTrajectoryCommand:
    """Return the points of a message that name every joint's position."""
    count = len(message.joint_names)
    points = [point for point in message.points if len(point.positions) == count]
    return commands.PositionTrajectoryCommand(
        tuple(message.joint_names),
        np.array([seconds(point.time_from_start) for point in points]),
        np.array([list(point.positions) for point in points]).reshape(-1, count),
    )


OUTGOING: dict[type[samples.Sample], Outgoing] = {
    **IMAGES,
    **SENSORS,
    samples.LaserScanSample: Outgoing(_scan_type, _scan),
    samples.ImuSample: Outgoing(_imu_type, _imu),
    samples.OdometrySample: Outgoing(_odometry_type, _odometry),
    samples.TransformSample: Outgoing(_transforms_type, _transforms),
    samples.JointStateSample: Outgoing(_joint_state_type, _joint_state),
}
INCOMING: dict[type, Incoming] = {
    commands.TwistCommand: Incoming(named("geometry_msgs", "Twist"), _twist),
    commands.WrenchCommand: Incoming(named("geometry_msgs", "Wrench"), _wrench),
    commands.SignalCommand: Incoming(named("std_msgs", "Empty"), lambda message: commands.SignalCommand()),
    commands.FlagCommand: Incoming(named("std_msgs", "Bool"), lambda message: commands.FlagCommand(message.data)),
    commands.NumberCommand: Incoming(named("std_msgs", "Float64"), _number),
    commands.PositionTrajectoryCommand: Incoming(_trajectory_type, trajectory_of),
}


def outgoing(kind: type[samples.Sample]) -> Outgoing | None:
    """Return how a class of samples becomes a message, if anyone knows.

    A user's class may derive from one of ours, or bring ``message_class`` and ``to_message`` of its own.
    """
    if hasattr(kind, "message_class") and hasattr(kind, "to_message"):
        return Outgoing(kind.message_class, kind.to_message)
    return next((OUTGOING[cls] for cls in kind.__mro__ if cls in OUTGOING), None)
