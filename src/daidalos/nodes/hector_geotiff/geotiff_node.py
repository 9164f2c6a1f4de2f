"""`geotiff_node`: writes pictures of the map and the robot's way, when asked for or periodically."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from rclpy.node import Node

from daidalos.common.errors import UserError
from daidalos.mapping.geotiff import draw_geotiff, write_geotiff
from daidalos.mapping.grid import OccupancyGrid
from daidalos.nodes.conversions import grid_array, path_array, pose2_of
from daidalos.nodes.hector_geotiff._parameters import GeotiffParameters
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run

COMMAND = "savegeotiff"
WAY_TIMEOUT = 2.0
"""Time [s] after which a picture is written without the way, where its service does not answer."""


class GeotiffNode(Node):
    """Node that writes ``BASE_DATE_TIME.tif`` and ``.tfw`` of ``map`` for the text ``savegeotiff`` on ``syscommand``.

    The way of the robot comes from the service ``trajectory`` of `hector_trajectory_server`, where there is one.
    Date and time in the name are those of the node's clock, in UTC. Its parameters are those of `GeotiffParameters`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("hector_geotiff_node", **kwargs)
        from hector_nav_msgs.srv import GetRobotTrajectory
        from nav_msgs.msg import OccupancyGrid as GridMessage
        from std_msgs.msg import String

        self._settings = declare(self, GeotiffParameters)
        self._map: Any = None
        self._waiting: Any = None
        self._request = GetRobotTrajectory.Request
        self._way_client = self.create_client(GetRobotTrajectory, "trajectory")
        self._patience = self.create_timer(WAY_TIMEOUT, self._write_without_way, autostart=False)
        self.create_subscription(GridMessage, "map", self._on_map, LATCHED)
        self.create_subscription(String, "syscommand", self._on_command, 10)
        if self._settings.geotiff_save_period > 0:
            self.create_timer(self._settings.geotiff_save_period, self._save)

    def _on_map(self, message: Any) -> None:
        self._map = message

    def _on_command(self, message: Any) -> None:
        if message.data == COMMAND:
            self._save()

    def _save(self) -> None:
        """Ask for the way, after which the picture is written."""
        if self._map is None:
            self.get_logger().error("no picture is written: there is no map yet")
        elif self._waiting is None and self._way_client.service_is_ready():
            self._waiting = self._way_client.call_async(self._request())
            self._waiting.add_done_callback(self._on_way)
            self._patience.reset()
        elif self._waiting is None:
            self.get_logger().warning("there is no service 'trajectory': the picture is written without the way")
            self._write(np.empty((0, 2)))

    def _on_way(self, future: Any) -> None:
        if future is self._waiting and not future.cancelled():
            self._stop_waiting()
            self._write(path_array(future.result().trajectory)[:, :2])

    def _write_without_way(self) -> None:
        self._stop_waiting()
        self.get_logger().warning("the service 'trajectory' does not answer: the picture is written without the way")
        self._write(np.empty((0, 2)))

    def _stop_waiting(self) -> None:
        waiting, self._waiting = self._waiting, None
        self._patience.cancel()
        if waiting is not None:
            waiting.cancel()

    def _write(self, way: np.ndarray[Any, np.dtype[np.float64]]) -> None:
        settings = self._settings
        now = datetime.fromtimestamp(self.get_clock().now().nanoseconds * 1e-9, UTC)
        name = f"{settings.map_file_base_name}_{now:%Y-%m-%d_%H-%M-%S}"
        try:
            info = self._map.info
            x, y, yaw = pose2_of(info.origin)
            picture = draw_geotiff(
                OccupancyGrid(grid_array(self._map), info.resolution, (x, y, yaw)),
                way[np.isfinite(way).all(axis=1)],
                checkerboard=settings.draw_background_checkerboard,
                free_space_grid=settings.draw_free_space_grid,
            )
            image, _ = write_geotiff(Path(settings.map_file_path).expanduser() / name, picture)
        except (UserError, ValueError) as error:
            self.get_logger().error(f"no picture is written: {error}")
            return
        self.get_logger().info(f"wrote {image} with {len(way)} poses of the way")


def main() -> int:
    """Run the node."""
    return run(GeotiffNode)
