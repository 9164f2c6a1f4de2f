"""`map_server`: publishes the map of a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.errors import MapFileError
from daidalos.mapping.map_file import load_map
from daidalos.nodes.conversions import grid_message, pose_message
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.packages import package_share
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED


@dataclass(frozen=True)
class MapServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    yaml_filename: str = parameter("", "Map file that is read when the node is configured; empty for none.")
    topic_name: str = parameter("map", "Topic of the map.", not_empty=True, read_only=True)
    frame_id: str = parameter("map", "Frame of the map.", not_empty=True)
    autostart_node: bool = parameter(False, "Whether the node configures and activates itself.", read_only=True)


class MapServer(ManagedNode):
    """Node that publishes a latched map, and serves ``~/map`` and ``~/load_map``.

    Its parameters are those of `MapServerParameters`.
    """

    def __init__(self, node_name: str = "map_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, MapServerParameters, reconfigure=self._reconfigure)
        self._map: Any = None
        if self._settings.autostart_node:
            self._start_timer = self.create_timer(0.0, self._autostart)

    def _reconfigure(self, parameters: MapServerParameters) -> None:
        """Use another file at the next configuration, and another frame for the next file."""
        self._settings = parameters

    def _autostart(self) -> None:
        self.destroy_timer(self._start_timer)
        if self.trigger_configure() == TransitionCallbackReturn.SUCCESS:
            self.trigger_activate()

    def configure(self) -> None:
        """Read the map and serve."""
        from nav2_msgs.srv import LoadMap
        from nav_msgs.msg import OccupancyGrid
        from nav_msgs.srv import GetMap

        file = self._settings.yaml_filename
        self._map = self._load(file) if file else None
        if not file:
            self.get_logger().info("yaml_filename parameter is empty, set map through '~/load_map' service")
        self._publisher = self.create_publisher(OccupancyGrid, self._settings.topic_name, LATCHED)
        self.create_service(GetMap, "~/map", self._on_get_map)
        self.create_service(LoadMap, "~/load_map", self._on_load_map)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish the map."""
        self._publish()
        return super().on_activate(state)

    def _load(self, url: str) -> Any:
        return read_map(self, url, self._settings.frame_id)

    def _publish(self) -> None:
        if self._map is not None:
            self._publisher.publish(self._map)

    def _on_get_map(self, request: Any, response: Any) -> Any:
        if not self.is_active:
            self.get_logger().warning("Received GetMap request but not in ACTIVE state, ignoring!")
        elif self._map is not None:
            response.map = self._map
        return response

    def _on_load_map(self, request: Any, response: Any) -> Any:
        if not self.is_active:
            self.get_logger().warning("Received LoadMap request but not in ACTIVE state, ignoring!")
            response.result = response.RESULT_UNDEFINED_FAILURE
            return response
        try:
            self._map = self._load(request.map_url)
        except MapFileError as error:
            self.get_logger().error(f"Failed to load map: {error}")
            response.result = load_result(error, response)
            return response
        self._publish()
        response.map = self._map
        response.result = response.RESULT_SUCCESS
        return response


def read_map(node: Node, url: str, frame: str) -> Any:
    """Return a map file as a ``nav_msgs/msg/OccupancyGrid``.

    Parameters
    ----------
    node
        Whose clock and log are used.
    url
        A path, or a URL with ``file://`` or ``package://``.
    frame
        Of the map.

    Raises
    ------
    MapFileError
        When it cannot be read.
    """
    grid = load_map(_path_of(url))
    message = grid_message(grid.data, grid.resolution, grid.origin[:2], frame, node.get_clock().now().to_msg())
    message.info.origin = pose_message(grid.origin)
    rows, columns = grid.data.shape
    node.get_logger().info(f"Read map {url}: {columns} X {rows} map @ {grid.resolution:.3g} m/cell")
    return message


def load_result(error: MapFileError, response: Any) -> int:
    """Return the result code of a ``LoadMap`` response for an error."""
    of_yaml = error.path.suffix in (".yaml", ".yml")
    if of_yaml and not error.path.exists():
        return int(response.RESULT_MAP_DOES_NOT_EXIST)
    return int(response.RESULT_INVALID_MAP_METADATA if of_yaml else response.RESULT_INVALID_MAP_DATA)


def _path_of(url: str) -> Path:
    """Return the file that a path or a URL with ``file://`` or ``package://`` names."""
    if url.startswith("package://"):
        package, _, rest = url.removeprefix("package://").partition("/")
        share = package_share(package)
        if share is None:
            raise MapFileError(Path(url), None, f"there is no package '{package}'")
        return Path(share) / rest
    return Path(url.removeprefix("file://"))
