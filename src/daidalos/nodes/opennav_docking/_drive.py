"""Drive of the docking server: the robot's pose, its velocity, and obstacles on its way."""

from __future__ import annotations

from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from daidalos.common.arrays import Array
from daidalos.common.pose2 import compose, wrap
from daidalos.navigation.controllers.rotation import rotation_speed
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.docking.approach import ApproachParameters, obstacle_on, projected_path
from daidalos.navigation.errors import FailedToControl
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import path_message, pose2_of_transform, twist_message, velocity_of
from daidalos.nodes.nav2_costmap_2d._costmap_listener import CostmapListener
from daidalos.samples.fields import nanoseconds


class Drive:
    """Robot as the docking server sees and moves it.

    Parameters
    ----------
    node : Node
    buffer : Buffer
    settings : DockingServerParameters
    parameters : ApproachParameters
        Replaced when they are reconfigured.
    """

    def __init__(self, node: Node, buffer: Buffer, settings: Any, parameters: ApproachParameters) -> None:
        from geometry_msgs.msg import Twist, TwistStamped
        from nav_msgs.msg import Odometry, Path

        self._node = node
        self._buffer = buffer
        self._settings = settings
        self.parameters = parameters
        self._stamped = settings.enable_stamped_cmd_vel
        self._command = node.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 1)
        self._trajectory = node.create_publisher(Path, "docking_trajectory", 1)
        self._turn_rate = 0.0
        node.create_subscription(Odometry, settings.odom_topic, self._on_odometry, 1)
        self._surroundings: CostmapListener | None = None
        if parameters.use_collision_detection:
            self._surroundings = CostmapListener(
                node, buffer, settings.base_frame, parameters.costmap_topic, parameters.footprint_topic,
                Footprint.circle(0.1),
            )  # fmt: skip

    def _on_odometry(self, message: Any) -> None:
        self._turn_rate = float(velocity_of(message.twist.twist)[2])

    # Poses.

    def pose(self, frame: str = "", of: str = "", *, max_age: float | None = None) -> Array:
        """Return the pose (x, y, yaw) of the robot, or another frame, in the fixed or another frame.

        Raises
        ------
        TransformFailed
            It is not known, or the robot's is older than ``data_timeout``.
        """
        try:
            found = self._buffer.lookup_transform(
                frame or self._settings.fixed_frame, of or self._settings.base_frame, Time()
            )
        except TransformException as error:
            raise TransformFailed(str(error)) from None
        stamp_ns = nanoseconds(found.header.stamp)
        age = (self._node.get_clock().now().nanoseconds - stamp_ns) * 1e-9 if stamp_ns and not of else 0.0
        if age > self._settings.data_timeout:
            raise TransformFailed(
                f"the robot's transform is {age:.3g} s old, longer than {self._settings.data_timeout:g} s"
            )
        return pose2_of_transform(found.transform)

    def in_fixed_frame(self, pose: Array, frame: str) -> Array:
        """Return a pose of another frame in the fixed frame."""
        fixed = self._settings.fixed_frame
        return pose if frame in ("", fixed) else compose(self.pose(of=frame), pose)

    # Motions.

    def stop(self) -> None:
        """Command the robot to stand."""
        self._publish(np.zeros(3))

    def approach(self, target: Array, *, backward: bool, dock: Array) -> None:
        """Command the velocity of one cycle towards a pose.

        Parameters
        ----------
        target, dock : ndarray, shape (3,)
            Where to, and where the dock is, in the fixed frame.
        backward : bool

        Raises
        ------
        FailedToControl
            There is an obstacle on the way, or it is not known whether there is one.
        """
        robot = self.pose()
        self._require_free(robot, target, backward=backward, dock=dock)
        speed, turn = self.parameters.law.velocity(robot, target, backward=backward)
        self._publish(np.array([speed, 0.0, turn]))

    def turn_to(self, yaw: float, tolerance: float) -> bool:
        """Command the velocity of one cycle of a turn in place; return whether it is done."""
        angle = float(wrap(yaw - self.pose()[2]))
        if abs(angle) < tolerance:
            self.stop()
            return True
        p = self.parameters
        rate = rotation_speed(
            angle, self._turn_rate, max_speed=p.rotate_to_heading_angular_vel,
            max_accel=p.rotate_to_heading_max_angular_accel, period=1.0 / self._settings.controller_frequency,
        )  # fmt: skip
        self._publish(np.array([0.0, 0.0, rate]))
        return False

    def _require_free(self, robot: Array, target: Array, *, backward: bool, dock: Array) -> None:
        path = projected_path(self.parameters, robot, target, backward=backward)
        if self._trajectory.handle.has_subscribers:
            now = self._node.get_clock().now().to_msg()
            self._trajectory.publish(path_message(path, self._settings.fixed_frame, now))
        if self._surroundings is None:
            return
        p, costmap, age = self.parameters, self._surroundings.costmap, self._surroundings.age
        if costmap is None:
            raise FailedToControl(f"there is no costmap on '{p.costmap_topic}'")
        if age > self._settings.data_timeout:
            raise FailedToControl(
                f"the costmap on '{p.costmap_topic}' is {age:.3g} s old, longer than {self._settings.data_timeout:g} s"
            )
        if self._surroundings.frame != self._settings.fixed_frame:
            offset = self.pose(self._surroundings.frame, self._settings.fixed_frame)
            path, dock = compose(offset, path), compose(offset, dock)
        hit = obstacle_on(path, costmap, self._surroundings.footprint, dock, p.dock_collision_threshold)
        if hit is not None:
            raise FailedToControl(f"there is an obstacle on the way, at ({hit[0]:.2f}, {hit[1]:.2f})")

    def _publish(self, velocity: Array) -> None:
        frame = self._settings.base_frame if self._stamped else None
        self._command.publish(twist_message(velocity, frame, self._node.get_clock().now().to_msg()))
