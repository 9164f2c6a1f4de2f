"""`loopback_simulator`: a robot that obeys velocities exactly, is localized exactly, and sees the map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

from daidalos.common.errors import UserError
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.common.pose2 import between, compose, inverse, move_along_arc
from daidalos.mapping.ray_casting import cast_rays
from daidalos.nodes.conversions import (
    grid_array,
    pose2_of,
    pose2_of_transform,
    pose_message,
    transform_stamped,
    twist_message,
    velocity_of,
)
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.samples.fields import time_message

_OCCUPIED = 60
"""Occupancy from which on a cell of the map stops rays."""

_COMMAND_TIMEOUT_S = 1.0
"""Age [s] of the last command from which on the robot stands."""


@dataclass(frozen=True)
class LoopbackSimulatorParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    update_duration: float = parameter(0.01, "Period of the motion.", unit="s", above=0.0)
    base_frame_id: str = parameter("base_footprint", "Frame of the robot's base.", not_empty=True)
    odom_frame_id: str = parameter("odom", "Frame of the odometry.", not_empty=True)
    map_frame_id: str = parameter("map", "Frame of the map.", not_empty=True)
    scan_frame_id: str = parameter("base_scan", "Frame of the scans.", not_empty=True)
    enable_stamped_cmd_vel: bool = parameter(False, "Whether cmd_vel is stamped.")
    publish_map_odom_tf: bool = parameter(True, "Whether the robot is localized.")
    publish_clock: bool = parameter(True, "Whether the clock is published.")
    scan_publish_dur: float = parameter(0.1, "Period of the scans.", unit="s", above=0.0)
    scan_range_min: float = parameter(0.05, "Shortest distance that is measured.", unit="m", minimum=0.0)
    scan_range_max: float = parameter(30.0, "Longest distance that is measured.", unit="m", above=0.0)
    scan_angle_min: float = parameter(-math.pi, "Direction of the first ray.", unit="rad")
    scan_angle_max: float = parameter(math.pi, "Direction of the last ray.", unit="rad")
    scan_angle_increment: float = parameter(0.0261, "Angle between two rays.", unit="rad", above=0.0)
    scan_use_inf: bool = parameter(True, "Whether rays without end are infinite, rather than 0.1 m too short.")

    def check(self) -> None:
        """Refuse angles of which the last comes before the first."""
        if self.scan_angle_max <= self.scan_angle_min:
            raise ParameterError("scan_angle_max", f"must be above scan_angle_min, got {self.scan_angle_max:g}")


class LoopbackSimulator(Node):
    """Node that integrates ``cmd_vel`` from the pose of ``initialpose`` on."""

    def __init__(self, node_name: str = "loopback_simulator", **kwargs: Any) -> None:
        from geometry_msgs.msg import PoseWithCovarianceStamped, Twist, TwistStamped
        from nav_msgs.msg import OccupancyGrid, Odometry
        from rosgraph_msgs.msg import Clock
        from sensor_msgs.msg import LaserScan

        super().__init__(node_name, **kwargs)
        p = self._settings = declare(self, LoopbackSimulatorParameters)
        self._map_to_odom, self._pose, self._velocity = np.zeros(3), np.zeros(3), np.zeros(3)
        self._is_placed = False
        self._commanded_ns = 0
        self._map: Any = None
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._transforms = TransformBroadcaster(self)
        self._odometry = self.create_publisher(Odometry, "odom", 10)
        self._scans = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self._clock_publisher = self.create_publisher(Clock, "/clock", 10) if p.publish_clock else None
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 10)
        self.create_subscription(OccupancyGrid, "map", self._on_map, LATCHED)
        kind = TwistStamped if p.enable_stamped_cmd_vel else Twist
        self.create_subscription(kind, "cmd_vel", self._on_command, 10)
        self.create_timer(p.update_duration, self._move)
        self.create_timer(p.scan_publish_dur, self._scan)

    def _on_map(self, message: Any) -> None:
        try:
            grid_array(message)
        except UserError as error:
            self.get_logger().error(str(error))
            return
        self._map = message

    def _on_initial_pose(self, message: Any) -> None:
        """Put the robot somewhere else; the odometry does not jump."""
        pose = pose2_of(message.pose.pose)
        if not np.isfinite(pose).all():
            self.get_logger().error("an initial pose is not finite; the robot stays where it is")
            return
        self._map_to_odom = compose(pose, inverse(self._pose))
        self._is_placed = True

    def _on_command(self, message: Any) -> None:
        velocity = velocity_of(getattr(message, "twist", message))
        if not np.isfinite(velocity).all():
            self.get_logger().error("a velocity is not finite; the robot stops", throttle_duration_sec=5.0)
            velocity = np.zeros(3)
        self._velocity = velocity
        self._commanded_ns = self.get_clock().now().nanoseconds

    def _move(self) -> None:
        """Move the robot for one period, and publish where it is."""
        from rosgraph_msgs.msg import Clock

        p, now_ns = self._settings, self.get_clock().now().nanoseconds
        if not 0 <= now_ns - self._commanded_ns <= 1e9 * _COMMAND_TIMEOUT_S:
            self._velocity = np.zeros(3)
        if self._is_placed:
            x, y, turn = (self._velocity * p.update_duration).tolist()
            self._pose = move_along_arc(self._pose, x, turn, y)
        stamp, ahead = time_message(now_ns), time_message(now_ns + round(1e9 * p.update_duration))
        if self._clock_publisher is not None:
            self._clock_publisher.publish(Clock(clock=stamp))
        transforms = [transform_stamped(self._pose, p.odom_frame_id, p.base_frame_id, stamp)]
        if p.publish_map_odom_tf and self._is_placed:
            transforms.append(transform_stamped(self._map_to_odom, p.map_frame_id, p.odom_frame_id, ahead))
        self._transforms.sendTransform(transforms)
        self._publish_odometry(stamp)

    def _publish_odometry(self, stamp: Any) -> None:
        from nav_msgs.msg import Odometry

        message = Odometry(child_frame_id=self._settings.base_frame_id)
        message.header.stamp, message.header.frame_id = stamp, self._settings.odom_frame_id
        message.pose.pose = pose_message(self._pose)
        message.twist.twist = twist_message(self._velocity if self._is_placed else np.zeros(3), None, stamp)
        self._odometry.publish(message)

    def _scan(self) -> None:
        """Publish what a lidar sees of the map; nothing but free space where there is no map."""
        from sensor_msgs.msg import LaserScan

        p = self._settings
        count = int((p.scan_angle_max - p.scan_angle_min) / p.scan_angle_increment)
        angles = p.scan_angle_min + p.scan_angle_increment * np.arange(count)
        ranges = self._ranges(angles)
        ranges[(ranges < p.scan_range_min) | (ranges > p.scan_range_max)] = np.inf
        if not p.scan_use_inf:
            ranges[np.isinf(ranges)] = p.scan_range_max - 0.1
        message = LaserScan(
            angle_min=p.scan_angle_min, angle_max=float(angles[-1]), angle_increment=p.scan_angle_increment,
            scan_time=p.scan_publish_dur, range_min=p.scan_range_min, range_max=p.scan_range_max,
            ranges=ranges.astype(np.float32),
        )  # fmt: skip
        message.header.stamp, message.header.frame_id = self.get_clock().now().to_msg(), p.scan_frame_id
        self._scans.publish(message)

    def _ranges(self, angles: Any) -> Any:
        p, grid = self._settings, self._map
        nothing = np.full(angles.shape, np.inf)
        if grid is None or not self._is_placed:
            return nothing
        try:
            mount = pose2_of_transform(
                self._buffer.lookup_transform(p.base_frame_id, p.scan_frame_id, Time()).transform
            )
        except TransformException as error:
            self.get_logger().warning(f"the scans are empty: {error}", throttle_duration_sec=5.0)
            return nothing
        sensor = compose(compose(self._map_to_odom, self._pose), mount)
        in_grid = between(pose2_of(grid.info.origin), sensor)
        return cast_rays(
            grid_array(grid) >= _OCCUPIED, grid.info.resolution, np.zeros(2), in_grid, angles, p.scan_range_max
        )
