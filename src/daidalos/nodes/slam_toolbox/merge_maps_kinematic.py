"""`merge_maps_kinematic`: saved maps that are put beside each other by hand and drawn as one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from rclpy.node import Node

from daidalos.common import pose2
from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.mapping.errors import MappingError
from daidalos.nodes.conversions import grid_message, pose2_of, pose_message, transform_stamped
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._graph_markers import movable, sphere

_HANDLE_SIZE = 2.0
"""Diameter [m] of the marker by which a map is moved."""


@dataclass(frozen=True)
class MergeParameters(Parameters):
    """Parameters of the node."""

    resolution: float = parameter(0.05, "Side of a cell of the maps.", unit="m", above=0.0, read_only=True)


@dataclass
class _Submap:
    """A saved map: its scans, the middle of its grid at first, and where that middle was moved to."""

    saved: Any
    grid: Any
    middle: Array
    place: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def correction(self) -> Array:
        """Pose of the saved map's frame in the frame of the merged one."""
        return pose2.compose(self.place, pose2.inverse(self.middle))


class MergeMapsKinematic(Node):
    """Node that shows saved pose graphs as ``map_1``, ``map_2`` and so on, and merges them into ``map``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("slam_toolbox", **kwargs)
        from interactive_markers import InteractiveMarkerServer
        from nav_msgs.msg import MapMetaData, OccupancyGrid
        from slam_toolbox.srv import AddSubmap, MergeMaps
        from tf2_ros import StaticTransformBroadcaster

        self._settings = declare(self, MergeParameters)
        self._submaps: list[_Submap] = []
        self._map_publisher = self.create_publisher(OccupancyGrid, "map", LATCHED)
        self._metadata_publisher = self.create_publisher(MapMetaData, "map_metadata", LATCHED)
        self._submap_publishers: list[Any] = []
        self._broadcaster = StaticTransformBroadcaster(self)
        self._markers = InteractiveMarkerServer(self, "merge_maps_tool")
        self.create_service(AddSubmap, "slam_toolbox/add_submap", self._on_add)
        self.create_service(MergeMaps, "slam_toolbox/merge_submaps", self._on_merge)

    def _on_add(self, request: Any, response: Any) -> Any:
        from nav_msgs.msg import OccupancyGrid

        from daidalos.mapping.grid import draw_scans
        from daidalos.mapping.pose_graph_file import load_pose_graph

        try:
            saved = load_pose_graph(request.filename)
        except MappingError as error:
            self.get_logger().error(f"cannot add the map: {error}")
            return response
        grid = draw_scans(saved.clouds, saved.poses, self._settings.resolution)
        rows, columns = grid.data.shape
        size = grid.resolution * np.array([columns, rows, 0.0])
        middle = np.array(grid.origin) + 0.5 * size
        self._submaps.append(_Submap(saved, grid, middle, middle.copy()))
        number = len(self._submaps)
        self._submap_publishers.append(self.create_publisher(OccupancyGrid, f"map_{number}", LATCHED))
        stamp = self.get_clock().now().to_msg()
        origin = np.array([*(-0.5 * size[:2]), 0.0])
        self._submap_publishers[-1].publish(grid_message(grid.data, grid.resolution, origin, f"map_{number}", stamp))
        self._show_handle(number)
        self._place(number)
        self.get_logger().info(f"added {request.filename} as map_{number}")
        return response

    def _show_handle(self, number: int) -> None:
        place, stamp = self._submaps[number - 1].place, self.get_clock().now().to_msg()
        marker = sphere(number, np.zeros(3), "map", stamp, _HANDLE_SIZE)
        handle = movable(marker, str(number), 1.2 * _HANDLE_SIZE)
        handle.pose = pose_message(place)
        self._markers.insert(handle, feedback_callback=self._on_feedback)
        self._markers.applyChanges()

    def _on_feedback(self, feedback: Any) -> None:
        if feedback.event_type in (feedback.MOUSE_UP, feedback.POSE_UPDATE):
            number = int(feedback.marker_name)
            self._submaps[number - 1].place = pose2_of(feedback.pose)
            self._place(number)

    def _place(self, number: int) -> None:
        """Publish where a map was put."""
        stamp = self.get_clock().now().to_msg()
        place = self._submaps[number - 1].place
        self._broadcaster.sendTransform(transform_stamped(place, "map", f"map_{number}", stamp))

    def _on_merge(self, request: Any, response: Any) -> Any:
        from daidalos.mapping.grid import draw_scans

        if not self._submaps:
            self.get_logger().warning("there are no maps to be merged: slam_toolbox/add_submap adds them")
            return response
        clouds = [cloud for submap in self._submaps for cloud in submap.saved.clouds]
        poses = np.concatenate([pose2.compose(submap.correction, submap.saved.poses) for submap in self._submaps])
        grid = draw_scans(clouds, poses, self._settings.resolution)
        stamp = self.get_clock().now().to_msg()
        message = grid_message(grid.data, grid.resolution, grid.origin, "map", stamp)
        self._map_publisher.publish(message)
        self._metadata_publisher.publish(message.info)
        self.get_logger().info(f"merged {len(self._submaps)} maps")
        return response


def main() -> int:
    """Run the node."""
    return run(MergeMapsKinematic)
