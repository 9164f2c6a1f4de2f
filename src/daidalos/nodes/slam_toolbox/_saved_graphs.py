"""Saving and loading of pose graphs by the services of slam_toolbox's nodes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.common.errors import UserError
from daidalos.mapping.errors import MappingError

if TYPE_CHECKING:
    from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox


class SavedGraphs:
    """The services ``slam_toolbox/serialize_map`` and ``slam_toolbox/deserialize_map``.

    Parameters
    ----------
    node
        Has the map, and refuses what its kind of node cannot do.
    """

    def __init__(self, node: SlamToolbox) -> None:
        from slam_toolbox.srv import DeserializePoseGraph, SerializePoseGraph

        self._node = node
        node.create_service(SerializePoseGraph, "slam_toolbox/serialize_map", self._on_serialize)
        node.create_service(DeserializePoseGraph, "slam_toolbox/deserialize_map", self._on_deserialize)

    def load(self, name: str) -> Any:
        """Return a saved pose graph.

        Raises
        ------
        MapFileError
            When it cannot be read.
        """
        from daidalos.mapping.pose_graph_file import load_pose_graph

        saved = load_pose_graph(name)
        self._node.get_logger().info(f"read a pose graph of {len(saved.clouds)} scans from {name}")
        resolution = self._node.settings.resolution
        if saved.resolution != resolution:
            self._node.get_logger().info(
                f"its map had cells of {saved.resolution:g} m and is drawn with {resolution:g} m now"
            )
        return saved

    def _on_serialize(self, request: Any, response: Any) -> Any:
        from daidalos.mapping.pose_graph_file import save_pose_graph

        response.result = response.RESULT_FAILED_TO_WRITE_FILE
        problem = self._node.refusal_to_save()
        if not problem and (self._node.slam is None or not self._node.slam.key_count):
            problem = "there is no map yet"
        if not problem and not request.filename:
            problem = "the request has no filename"
        if problem:
            self._node.get_logger().error(f"cannot save the pose graph: {problem}")
            return response
        with self._node.lock:
            saved = self._node.slam.saved()
        try:
            files = save_pose_graph(saved, Path(request.filename))
        except MappingError as error:
            self._node.get_logger().error(f"cannot save the pose graph: {error}")
            return response
        response.result = response.RESULT_SUCCESS
        self._node.get_logger().info(f"saved {len(saved.clouds)} scans to {files[0]} and {files[1]}")
        return response

    async def _on_deserialize(self, request: Any, response: Any) -> Any:
        try:
            await self._deserialize(request)
        except UserError as error:
            self._node.get_logger().error(f"cannot load the pose graph: {error}")
        return response

    async def _deserialize(self, request: Any) -> None:
        refusal = self._node.refusal_to_load(request)
        if refusal:
            raise UserError(refusal)
        if not request.filename:
            raise UserError("the request has no filename")
        pose = (request.initial_pose.x, request.initial_pose.y, request.initial_pose.theta)
        if not np.isfinite(pose).all():
            raise UserError(f"expected a finite initial_pose, found {pose}")
        saved = self.load(request.filename)
        await self._node.ready
        slam = self._node.new_slam(saved)
        if request.match_type == request.START_AT_FIRST_NODE:
            slam.start_at_first()
        else:
            slam.start_at(pose)
        slam.render()
        self._node.use(slam)
