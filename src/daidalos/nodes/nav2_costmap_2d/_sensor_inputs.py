"""Inputs of costmap layers from the topics of sensors."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.qos import qos_profile_sensor_data

from daidalos.common.arrays import Array
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import Input
from daidalos.navigation.costmap.frozen_data import FrozenData
from daidalos.navigation.costmap.observation import CloudData, RangeData
from daidalos.nodes.conversions import cloud_data, pose2_of_transform, range_data, scan_data
from daidalos.nodes.transforms import SensorPoses
from daidalos.samples.fields import seconds

if TYPE_CHECKING:
    from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode

_LOG_S = 5.0


class SensorInputs:
    """Subscriptions to scans, clouds and ranges, which pass them on to layers with the pose of the robot.

    Parameters
    ----------
    costmap : CostmapNode
    judges_repetition : bool
        Whether data that stay the same while the robot moves are not used; for a costmap in whose frame the pose of
        the robot does not jump.
    """

    def __init__(self, costmap: CostmapNode, *, judges_repetition: bool) -> None:
        self._costmap = costmap
        self._judges_repetition = judges_repetition
        self._poses = SensorPoses(costmap.buffer, costmap.base_frame, costmap.get_logger(), costmap.global_frame)

    def listen_to_scans(self, listened: Input) -> None:
        """Subscribe to laser scans."""
        from sensor_msgs.msg import LaserScan

        def convert(scan: Any) -> LaserScanData | None:
            mount = self._poses.find(scan.header.frame_id)
            return None if mount is None else scan_data(scan, mount)

        self._listen(LaserScan, listened, convert)

    def listen_to_clouds(self, listened: Input) -> None:
        """Subscribe to point clouds."""
        from sensor_msgs.msg import PointCloud2

        def convert(cloud: Any) -> CloudData | None:
            transform = self._poses.transform(cloud.header.frame_id)
            return None if transform is None else cloud_data(cloud, transform)

        self._listen(PointCloud2, listened, convert)

    def listen_to_ranges(self, listened: Input) -> None:
        """Subscribe to sonars and infrared sensors."""
        from sensor_msgs.msg import Range

        def convert(message: Any) -> RangeData | None:
            mount = self._poses.find(message.header.frame_id)
            return None if mount is None else range_data(message, mount)

        self._listen(Range, listened, convert)

    def _listen(self, kind: Any, listened: Input, convert: Callable[[Any], Any]) -> None:
        """Pass messages on with the pose of the base at their time; `convert` returns None for what cannot be used."""
        costmap = self._costmap
        topic = costmap.outer_topic(listened.topic)
        frozen = FrozenData(costmap.footprint.circumscribed_radius)

        async def take(message: Any) -> None:
            sample = convert(message)
            if sample is None:
                return
            stamp = message.header.stamp
            found = await costmap.buffer.transform_at(costmap.global_frame, costmap.base_frame, stamp)
            if found is None:
                return
            pose = pose2_of_transform(found.transform)
            if self._judges_repetition and _repeats(frozen, sample, pose):
                costmap.get_logger().error(
                    f"'{topic}' repeats the same data while the robot moves; they are not used",
                    throttle_duration_sec=_LOG_S,
                )
                return
            with costmap.lock:
                listened.take(sample.lifted(found.transform.translation.z), pose, seconds(stamp))

        # A message waits for its transform; updates and services do not wait with it.
        group = MutuallyExclusiveCallbackGroup()
        costmap.create_subscription(kind, topic, take, qos_profile_sensor_data, callback_group=group)


def _repeats(frozen: FrozenData, sample: Any, pose: Array) -> bool:
    """Return whether a scan or cloud is frozen; a range may stay the same."""
    if isinstance(sample, LaserScanData):
        return frozen.repeats(sample.ranges, sample.ranges, pose)
    if isinstance(sample, CloudData):
        return frozen.repeats(sample.points, np.hypot(sample.points[:, 0], sample.points[:, 1]), pose)
    return False
