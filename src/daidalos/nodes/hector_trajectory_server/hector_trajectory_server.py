"""`hector_trajectory_server`: the way of a frame, read from the transforms, as a path."""

from __future__ import annotations

import math
from typing import Any

from rclpy.node import Node
from rclpy.time import Time

from daidalos.nodes.hector_trajectory_server._parameters import TrajectoryServerParameters
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run
from daidalos.samples.fields import nanoseconds

REPORT_INTERVAL = 10.0
"""Time [s] for which a missing transform that was reported is not reported again."""


class TrajectoryServer(Node):
    """Node that publishes ``trajectory``; the text ``reset`` on ``syscommand`` empties it.

    The service ``trajectory`` returns the path, ``trajectory_recovery_info`` its part that led to a place.
    Its parameters are those of `TrajectoryServerParameters`. A transform that time going back makes older than the
    last pose begins a new path.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("hector_trajectory_server", **kwargs)
        from hector_nav_msgs.srv import GetRecoveryInfo, GetRobotTrajectory
        from nav_msgs.msg import Path
        from std_msgs.msg import String
        from tf2_ros import Buffer, TransformListener

        self._settings = p = declare(self, TrajectoryServerParameters)
        self._path = Path()
        self._path.header.frame_id = p.target_frame_name
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._publisher = self.create_publisher(Path, "trajectory", LATCHED)
        self.create_subscription(String, "syscommand", self._on_command, 10)
        self.create_service(GetRobotTrajectory, "trajectory", self._on_trajectory)
        self.create_service(GetRecoveryInfo, "trajectory_recovery_info", self._on_recovery)
        self.create_timer(1.0 / p.trajectory_update_rate, self._record)
        self.create_timer(1.0 / p.trajectory_publish_rate, self._publish)

    def _record(self) -> None:
        """Add the latest pose to the path, unless it was added already."""
        from geometry_msgs.msg import Point, Pose, PoseStamped
        from tf2_py import TransformException

        p = self._settings
        try:
            found = self._buffer.lookup_transform_core(p.target_frame_name, p.source_frame_name, Time())
        except TransformException as error:
            text = f"no pose is recorded: {error}"
            self.get_logger().warning(text, throttle_duration_sec=REPORT_INTERVAL)
            return
        poses = self._path.poses
        if poses:
            ahead_ns = nanoseconds(found.header.stamp) - nanoseconds(poses[-1].header.stamp)
            if ahead_ns < 0:
                self.get_logger().warning("time went back; the path begins anew")
                self._reset()
            elif ahead_ns == 0:
                return
        moved = found.transform.translation
        pose = Pose(position=Point(x=moved.x, y=moved.y, z=moved.z), orientation=found.transform.rotation)
        self._path.poses.append(PoseStamped(header=found.header, pose=pose))

    def _publish(self) -> None:
        self._path.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(self._path)

    def _on_trajectory(self, _: Any, response: Any) -> Any:
        response.trajectory = self._path
        return response

    def _on_recovery(self, request: Any, response: Any) -> Any:
        """Return the path from where the robot came within the radius to where it was at the time, or just before."""
        time_ns = nanoseconds(request.request_time)
        poses = [one for one in self._path.poses if nanoseconds(one.header.stamp) <= time_ns]
        if not poses or not request.request_radius >= 0.0:
            text = f"no path to where the robot was at {time_ns * 1e-9:.2f} s is known"
            self.get_logger().error(f"{text}, or the radius {request.request_radius} is none")
            return response
        outside = (k for k in reversed(range(len(poses))) if _distance(poses[k], poses[-1]) > request.request_radius)
        led = poses[next(outside, 0) :]
        response.trajectory_radius_entry_pose_to_req_pose.header = self._path.header
        response.trajectory_radius_entry_pose_to_req_pose.poses = led
        response.radius_entry_pose, response.req_pose = led[0], led[-1]
        return response

    def _reset(self) -> None:
        self._path.poses = []

    def _on_command(self, message: Any) -> None:
        if message.data == "reset":
            self._reset()
            self.get_logger().info("the path was reset")


def _distance(first: Any, second: Any) -> float:
    """Return the distance [m] of two poses."""
    here, there = first.pose.position, second.pose.position
    return math.dist((here.x, here.y, here.z), (there.x, there.y, there.z))


def main() -> int:
    """Run the node."""
    return run(TrajectoryServer)
