"""`map_server`: publishes the map of a file, with ROS 1's arguments, topics and services."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import partial
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.errors import MapFileError
from daidalos.nodes.nav2_map_server.map_server import load_result, read_map
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import program_arguments, run


@dataclass(frozen=True)
class Ros1MapServerParameters(Parameters):
    """Parameters of the node, by their ROS 1 names."""

    frame_id: str = parameter("map", "Frame of the map.", not_empty=True)


class Ros1MapServer(Node):
    """Node that publishes a latched map, and serves ``static_map`` and ``change_map``.

    Parameters
    ----------
    file : str
        The map's YAML file.

    Raises
    ------
    MapFileError
        When it cannot be read.
    """

    def __init__(self, file: str, **kwargs: Any) -> None:
        super().__init__("map_server", **kwargs)
        from nav_msgs.msg import MapMetaData, OccupancyGrid
        from nav_msgs.srv import GetMap, LoadMap

        self._settings = declare(self, Ros1MapServerParameters, reconfigure=self._reconfigure)
        self._map_publisher = self.create_publisher(OccupancyGrid, "map", LATCHED)
        self._metadata_publisher = self.create_publisher(MapMetaData, "map_metadata", LATCHED)
        self._publish(file)
        self.create_service(GetMap, "static_map", self._on_get_map)
        self.create_service(LoadMap, "change_map", self._on_change_map)

    def _reconfigure(self, parameters: Ros1MapServerParameters) -> None:
        """Use another frame for the next file."""
        self._settings = parameters

    def _publish(self, file: str) -> None:
        self._map = read_map(self, file, self._settings.frame_id)
        self._map_publisher.publish(self._map)
        self._metadata_publisher.publish(self._map.info)

    def _on_get_map(self, request: Any, response: Any) -> Any:
        response.map = self._map
        return response

    def _on_change_map(self, request: Any, response: Any) -> Any:
        try:
            self._publish(request.map_url)
        except MapFileError as error:
            self.get_logger().error(f"Failed to load map: {error}")
            response.result = load_result(error, response)
            return response
        response.map = self._map
        response.result = response.RESULT_SUCCESS
        return response


def main() -> int:
    """Run the node."""
    parser = argparse.ArgumentParser(prog="map_server", description="Publishes the map of a file")
    parser.add_argument("file", metavar="MAP.yaml", help="the map's YAML file")
    file = parser.parse_args(program_arguments()).file
    return run(partial(Ros1MapServer, file))
