"""`hector_mapping`: map and robot pose from scans alone, with ROS 1's parameters, topics and services."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time

from daidalos.common.arrays import Array
from daidalos.common.pose2 import compose, inverse
from daidalos.nodes.conversions import (
    SensorMount,
    grid_message,
    pose2_of,
    pose2_of_transform,
    pose_message,
    pose_stamped,
    scan_data,
    transform_stamped,
)
from daidalos.nodes.hector_mapping._parameters import WITHOUT_EFFECT, HectorMappingParameters
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run
from daidalos.nodes.scan_reports import ScanReports
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import nanoseconds

ODOMETRY_WAIT_NS = 500_000_000
"""How long [ns] the transform of a scan to odometry waits for that of the odometry."""

TIME_BACK_NS = 1_000_000_000
"""How far [ns] behind the last scan a scan shows that time was set back; others are late."""

_WATCH_PERIOD = 0.5
_XY_YAW = (0, 1, 5)
"""Rows of a pose's covariance (6, 6) that hold x, y and yaw."""


class HectorMapping(Node):
    """Node that publishes ``map``, ``slam_out_pose``, ``poseupdate`` and transforms of the map.

    Its parameters are those of `HectorMappingParameters`. It needs no odometry; where there is one, the transform from
    ``map_frame`` to ``odom_frame`` is published.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("hector_mapping", **kwargs)
        from tf2_ros import TransformBroadcaster, TransformListener

        from daidalos.nodes.transforms import BlockingBuffer, SensorPoses

        self._settings = p = declare(self, HectorMappingParameters, reconfigure=self._reconfigure)
        declare_without_effect(self, WITHOUT_EFFECT)
        self._slam: Any = None
        self._lock = threading.Lock()
        self._reports = ScanReports(self)
        self._is_paused = False
        self._start: Array | None = None
        self._last_stamp_ns: int | None = None
        self._unanchored: tuple[int, Any, Any] | None = None
        self._buffer = BlockingBuffer()
        self._listener = TransformListener(self._buffer, self)
        self._sensor_poses = SensorPoses(self._buffer, p.base_frame, self.get_logger())
        self._broadcaster = TransformBroadcaster(self)
        self._create_entities()
        self._compiled = warm_up_in_background("daidalos.mapping.hector", self.get_logger())
        self._compiled.add_done_callback(self._begin)

    def _create_entities(self) -> None:
        from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
        from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
        from nav_msgs.srv import GetMap
        from sensor_msgs.msg import LaserScan
        from std_msgs.msg import String
        from std_srvs.srv import SetBool, Trigger

        p = self._settings
        self._map_publisher = self.create_publisher(OccupancyGrid, "map", LATCHED)
        self._metadata_publisher = self.create_publisher(MapMetaData, "map_metadata", LATCHED)
        self._pose_publisher = self.create_publisher(PoseStamped, "slam_out_pose", 10)
        self._update_publisher = self.create_publisher(PoseWithCovarianceStamped, p.pose_update_topic, 10)
        self._odometry_publisher = self.create_publisher(Odometry, "scanmatch_odom", 50) if p.pub_odometry else None
        # A scan may wait for the transform that it starts from; the map and the services do not wait with it.
        scans = MutuallyExclusiveCallbackGroup()
        quality = QoSProfile(depth=p.scan_subscriber_queue_size, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(LaserScan, p.scan_topic, self._on_scan, quality, callback_group=scans)
        self.create_subscription(String, p.sys_msg_topic, self._on_command, 2)
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 2)
        self.create_service(Trigger, "reset_map", self._on_reset)
        self.create_service(SetBool, "pause_mapping", self._on_pause)
        if p.advertise_map_service:
            self.create_service(GetMap, "dynamic_map", self._on_get_map)
        self.create_timer(p.map_pub_period, self._publish_map)
        self.create_timer(_WATCH_PERIOD, self._watch)

    def _begin(self, compiled: Any) -> None:
        """Start to use scans."""
        from daidalos.mapping.hector.slam import HectorSlam

        compiled.result()
        with self._lock:
            self._slam = HectorSlam(self._settings)
        self._reports.start()
        self.get_logger().info("ready for scans")

    def _reconfigure(self, parameters: HectorMappingParameters) -> None:
        self._settings = parameters
        with self._lock:
            if self._slam is not None:
                self._slam.reconfigure(parameters)

    # Scans.

    async def _on_scan(self, scan: Any) -> None:
        self._reports.came()
        if self._slam is None or self._is_paused or not self._is_in_order(scan):
            return
        p, frame = self._settings, scan.header.frame_id
        mount: SensorMount | None = SensorMount(np.zeros(3), (0.0, 0.0))
        if p.use_tf_scan_transformation:
            mount = self._sensor_poses.mount(frame)
        if mount is None:
            self._reports.report("mount", f"scans of '{frame}' are not used: {self._sensor_poses.missing(frame)}")
            return
        start = self._start
        if start is None and (p.use_tf_pose_start_estimate or p.map_with_known_poses):
            start = await self._pose_by_transforms(scan)
            if start is None and p.map_with_known_poses:
                return
        self._use_scan(scan, mount, start)

    def _is_in_order(self, scan: Any) -> bool:
        """Return whether a scan is newer than the last one, or time was set back since."""
        stamp_ns, last_ns = nanoseconds(scan.header.stamp), self._last_stamp_ns
        if last_ns is not None and stamp_ns < last_ns:
            behind = 1e-9 * (last_ns - stamp_ns)
            if last_ns - stamp_ns <= TIME_BACK_NS:
                text = f"a scan of '{scan.header.frame_id}' is not used: it is {behind:.3f} s older than the last one"
                self._reports.report("order", text)
                return False
            self.get_logger().warning(f"time went back by {behind:.1f} s; the map is continued where the robot was")
            self._unanchored = None
        self._last_stamp_ns = stamp_ns
        return True

    async def _pose_by_transforms(self, scan: Any) -> Array | None:
        """Return where the transforms put the base in the map at a scan's time, None where they do not."""
        from tf2_py import TransformException

        p, stamp = self._settings, scan.header.stamp
        frames = (p.odom_frame, p.base_frame)
        if await self._buffer.transform_at(*frames, stamp) is not None:
            try:  # the map's transform to odometry is that of the scan before
                found = self._buffer.lookup_transform_full(
                    p.map_frame, Time(), p.base_frame, Time.from_msg(stamp), p.odom_frame
                )
                return pose2_of_transform(found.transform)
            except TransformException as error:
                why = str(error)
        else:
            why = f"{p.odom_frame} -> {p.base_frame} is known for later times only"
        self._reports.report("start", f"the transforms do not say where a scan was taken: {why}")
        return None

    def _use_scan(self, scan: Any, mount: SensorMount, start: Array | None) -> None:
        from daidalos.mapping.hector.slam import beam_ends

        p = self._settings
        begun = time.perf_counter()
        data = scan_data(scan, mount)
        with self._lock:
            heights = (p.laser_z_min_value, p.laser_z_max_value)
            ends = beam_ends(data, p.laser_min_dist, p.laser_max_dist, heights)
            result = self._slam.add_scan(data, ends, start, pose_is_known=p.map_with_known_poses)
        if p.output_timing:
            self.get_logger().info(f"a scan took {1e3 * (time.perf_counter() - begun):.2f} ms")
        if result.problem:
            kind = result.problem.rstrip("0123456789. ")
            self._reports.report(kind, f"a scan of '{scan.header.frame_id}' is not used: {result.problem}")
            return
        self._start = None
        if not p.map_with_known_poses:
            self._publish_pose(result, scan.header.stamp)

    # What is published of each scan.

    def _publish_pose(self, result: Any, stamp: Any) -> None:
        from geometry_msgs.msg import PoseWithCovariance, PoseWithCovarianceStamped
        from nav_msgs.msg import Odometry
        from std_msgs.msg import Header

        p = self._settings
        covariance = np.zeros((6, 6))
        covariance[np.ix_(_XY_YAW, _XY_YAW)] = result.covariance
        header = Header(frame_id=p.map_frame, stamp=stamp)
        pose = PoseWithCovariance(pose=pose_message(result.pose), covariance=covariance.ravel())
        self._update_publisher.publish(PoseWithCovarianceStamped(header=header, pose=pose))
        self._pose_publisher.publish(pose_stamped(result.pose, p.map_frame, stamp))
        if self._odometry_publisher is not None:
            self._odometry_publisher.publish(Odometry(header=header, child_frame_id=p.base_frame, pose=pose))
        if p.pub_map_scanmatch_transform:
            frame = p.tf_map_scanmatch_transform_frame_name
            self._broadcaster.sendTransform(transform_stamped(result.pose, p.map_frame, frame, stamp))
        if p.pub_map_odom_transform:
            self._publish_odometry_transform(result.pose, stamp)

    def _publish_odometry_transform(self, pose: Array, stamp: Any) -> None:
        """Publish the transform from the map to odometry, as soon as the odometry of the scan is known."""
        p = self._settings
        if p.odom_frame == p.base_frame:
            self._broadcaster.sendTransform(transform_stamped(pose, p.map_frame, p.odom_frame, stamp))
            return
        if self._unanchored is not None and not self._unanchored[2].done():
            if 0 <= self._reports.now_ns - self._unanchored[0] < ODOMETRY_WAIT_NS:
                return
            text = f"the transform {p.map_frame} -> {p.odom_frame} is not published:"
            _, why = self._buffer.can_transform_core(p.odom_frame, p.base_frame, self._unanchored[1])
            self._reports.report("odometry", f"{text} {why or 'that of the odometry came late'}")
            self._unanchored[2].cancel()
        odometry = self._buffer.transform_at(p.odom_frame, p.base_frame, stamp)
        self._unanchored = (self._reports.now_ns, stamp, odometry)

        def send(future: Any) -> None:
            if not future.cancelled() and future.result() is not None:
                base_to_odom = inverse(pose2_of_transform(future.result().transform))
                map_to_odom = compose(pose, base_to_odom)
                self._broadcaster.sendTransform(transform_stamped(map_to_odom, p.map_frame, p.odom_frame, stamp))

        odometry.add_done_callback(send)

    def _watch(self) -> None:
        """Report that no scans come."""
        if self._slam is not None and not self._is_paused and self._reports.is_silent():
            topic = self.resolve_topic_name(self._settings.scan_topic)
            count = self.count_publishers(topic)
            self._reports.report("silence", f"no scan comes on '{topic}', which has {count} publishers")

    # The map.

    def _map_message(self) -> Any:
        with self._lock:
            grid = self._slam.grid()
        stamp = self.get_clock().now().to_msg()
        return grid_message(grid.data, grid.resolution, grid.origin, self._settings.map_frame, stamp)

    def _publish_map(self) -> None:
        if self._slam is None or not self._slam.updates:
            return
        message = self._map_message()
        self._map_publisher.publish(message)
        self._metadata_publisher.publish(message.info)

    def _on_get_map(self, request: Any, response: Any) -> Any:
        if self._slam is not None:
            response.map = self._map_message()
        return response

    # What users ask for.

    def _reset(self) -> None:
        with self._lock:
            if self._slam is not None:
                self._slam.reset()
        self._start = None
        self.get_logger().info("the map was reset")

    def _on_command(self, message: Any) -> None:
        if message.data == "reset":
            self._reset()

    def _on_reset(self, request: Any, response: Any) -> Any:
        self._reset()
        response.success = True
        return response

    def _on_pause(self, request: Any, response: Any) -> Any:
        if self._is_paused != request.data:
            self.get_logger().info("mapping paused" if request.data else "mapping goes on")
        self._is_paused, response.success = request.data, True
        self._reports.start()
        return response

    def _on_initial_pose(self, message: Any) -> None:
        """Start the search of the next scan at a ``geometry_msgs/msg/PoseWithCovarianceStamped``."""
        frame, wanted = message.header.frame_id.lstrip("/"), self._settings.map_frame.lstrip("/")
        pose = pose2_of(message.pose.pose)
        if frame != wanted:
            self.get_logger().warning(f"an initial pose in the frame '{frame}' is ignored; it has to be in '{wanted}'")
        elif not np.isfinite(pose).all():
            self.get_logger().error("an initial pose is ignored: it is not finite")
        else:
            self._start = pose
            self.get_logger().info(f"the robot is looked for at {pose[0]:.3f} {pose[1]:.3f} {pose[2]:.3f}")


def main() -> int:
    """Run the node."""
    return run(HectorMapping)
