"""`async_slam_toolbox_node`: map and robot pose from scans and odometry."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.task import Future

from daidalos.common.parameters import parameter
from daidalos.mapping.config import SlamConfig
from daidalos.nodes.conversions import grid_message, pose2_of_transform, scan_data, transform_stamped
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import nanoseconds, time_message

_SCANS_A_MAP = 100
"""Scans that one publication of the map may move to where a loop closure wants them."""


@dataclass(frozen=True)
class SlamToolboxParameters(SlamConfig):
    """Parameters of the node: slam_toolbox's, and those of `SlamConfig`."""

    match_every_scan: bool = parameter(
        True, "Whether the scans in between correct the pose as well, without being added to the map."
    )
    map_frame: str = parameter("map", "Frame of the map.", not_empty=True, read_only=True)
    odom_frame: str = parameter("odom", "Frame of the odometry.", not_empty=True, read_only=True)
    base_frame: str = parameter("base_footprint", "Frame of the robot's base.", not_empty=True, read_only=True)
    scan_topic: str = parameter("/scan", "Topic of the scans.", not_empty=True, read_only=True)
    scan_queue_size: int = parameter(5, "Number of scans that wait.", minimum=1, read_only=True)
    throttle_scans: int = parameter(1, "Of so many scans one is used.", minimum=1)
    map_update_interval: float = parameter(1.0, "How often the map is published.", unit="s", above=0.0, read_only=True)
    transform_publish_period: float = parameter(
        0.02, "How often the transform is published; 0 for never.", unit="s", minimum=0.0, read_only=True
    )
    transform_timeout: float = parameter(0.2, "How far ahead the transform is stamped.", unit="s", minimum=0.0)


class SlamToolbox(Node):
    """Node that publishes ``map`` and the transform from ``map_frame`` to ``odom_frame``.

    Its parameters are those of `SlamToolboxParameters`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("slam_toolbox", **kwargs)
        from nav_msgs.msg import MapMetaData, OccupancyGrid
        from nav_msgs.srv import GetMap
        from sensor_msgs.msg import LaserScan
        from slam_toolbox.srv import Reset, SaveMap
        from tf2_ros import TransformBroadcaster, TransformListener

        from daidalos.nodes.transforms import BlockingBuffer, SensorPoses

        self._settings = p = declare(self, SlamToolboxParameters, reconfigure=self._reconfigure)
        self._slam: Any = None
        self._lock = threading.Lock()
        self._scans = 0
        self._drawn_keys = -1
        self._map_to_odom: Any = None
        self._buffer = BlockingBuffer()
        self._listener = TransformListener(self._buffer, self)
        self._sensor_poses = SensorPoses(self._buffer, p.base_frame, self.get_logger())
        self._broadcaster = TransformBroadcaster(self)
        self._map_publisher = self.create_publisher(OccupancyGrid, "map", LATCHED)
        self._metadata_publisher = self.create_publisher(MapMetaData, "map_metadata", LATCHED)
        # A scan may wait for its odometry; the map and the services do not wait with it.
        scans = MutuallyExclusiveCallbackGroup()
        self.create_subscription(LaserScan, p.scan_topic, self._on_scan, p.scan_queue_size, callback_group=scans)
        self.create_timer(p.map_update_interval, self._publish_map)
        if p.transform_publish_period > 0.0:
            own = MutuallyExclusiveCallbackGroup()
            self.create_timer(p.transform_publish_period, self._publish_transform, callback_group=own)
        self.create_service(SaveMap, "~/save_map", self._on_save)
        self.create_service(GetMap, "~/dynamic_map", self._on_get_map)
        self.create_service(Reset, "~/reset", self._on_reset)
        warm_up_in_background("daidalos.mapping", self.get_logger()).add_done_callback(self._begin)

    def _begin(self, compiled: Future) -> None:
        """Start to process scans."""
        compiled.result()
        self._slam = self._new_slam()
        self.get_logger().info("ready for scans")

    def _new_slam(self) -> Any:
        from daidalos.mapping.slam import Slam

        return Slam(self._settings)

    def _reconfigure(self, parameters: SlamToolboxParameters) -> None:
        self._settings = parameters
        if self._slam is not None:
            with self._lock:
                self._slam.reconfigure(parameters)

    async def _on_scan(self, scan: Any) -> None:
        self._scans += 1
        if self._scans % self._settings.throttle_scans or self._slam is None:
            return
        sensor_pose = self._sensor_poses.find(scan.header.frame_id)
        if sensor_pose is None:
            return
        # Odometry comes a little later than the scan that it belongs to.
        odometry = await self._buffer.transform_at(
            self._settings.odom_frame, self._settings.base_frame, scan.header.stamp
        )
        if odometry is None:
            return
        stamp_ns = nanoseconds(scan.header.stamp)
        data = scan_data(scan, sensor_pose)
        with self._lock:
            self._slam.add_scan(stamp_ns, data, pose2_of_transform(odometry.transform))
            self._map_to_odom = self._slam.map_to_odom

    def _publish_transform(self) -> None:
        if self._map_to_odom is None:
            return
        # Stamped ahead, as slam_toolbox does: those who ask for "now" need not wait for the next one.
        stamp = time_message(self.get_clock().now().nanoseconds + round(1e9 * self._settings.transform_timeout))
        frames = self._settings.map_frame, self._settings.odom_frame
        self._broadcaster.sendTransform(transform_stamped(self._map_to_odom, *frames, stamp))

    def _map_message(self) -> Any:
        with self._lock:
            grid = self._slam.grid(_SCANS_A_MAP)
        stamp = self.get_clock().now().to_msg()
        return grid_message(grid.data, grid.resolution, grid.origin, self._settings.map_frame, stamp)

    def _publish_map(self) -> None:
        if self._slam is None:
            return
        with self._lock:  # after a loop closure the grid goes on changing although no scan is added
            if self._slam.key_count == self._drawn_keys and not self._slam.render(0):
                return
        self._drawn_keys = self._slam.key_count
        message = self._map_message()
        if message.info.width and message.info.height:
            self._map_publisher.publish(message)
            self._metadata_publisher.publish(message.info)

    def _on_get_map(self, request: Any, response: Any) -> Any:
        if self._slam is not None:
            response.map = self._map_message()
        return response

    def _on_save(self, request: Any, response: Any) -> Any:
        from daidalos.mapping.errors import MappingError
        from daidalos.mapping.map_file import save_map

        name = request.name.data or "map"
        if self._slam is None or not self._slam.key_count:
            response.result = response.RESULT_NO_MAP_RECEIEVD
            return response
        with self._lock:
            grid = self._slam.grid()
        try:
            save_map(grid, name)
        except (OSError, MappingError) as error:
            self.get_logger().error(f"cannot save the map: {error}")
            response.result = response.RESULT_UNDEFINED_FAILURE
            return response
        response.result = response.RESULT_SUCCESS
        self.get_logger().info(f"saved the map to {name}.pgm and {name}.yaml")
        return response

    def _on_reset(self, request: Any, response: Any) -> Any:
        with self._lock:
            if self._slam is not None:
                self._slam = self._new_slam()
            self._map_to_odom = None
            self._drawn_keys = -1
        response.result = response.RESULT_SUCCESS
        return response


def main() -> int:
    """Run the node."""
    return run(SlamToolbox)
