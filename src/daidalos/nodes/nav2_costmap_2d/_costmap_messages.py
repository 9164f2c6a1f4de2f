"""Conversion of costmaps and footprints to and from messages."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.voxels import VoxelGrid
from daidalos.nodes.conversions import pose_message


def costmap_message(costmap: Costmap, frame: str, stamp: Any, updated: Any | None = None) -> Any:
    """Return a ``nav2_msgs/msg/Costmap``: the costs themselves, without a loss.

    Parameters
    ----------
    costmap : Costmap
    frame : str
        Frame of the costmap.
    stamp : builtin_interfaces/msg/Time
        Time of the message.
    updated : builtin_interfaces/msg/Time, optional
        When all that the costmap shows was last known; the same where it is left out.
    """
    from nav2_msgs.msg import Costmap as CostmapMessage
    from nav2_msgs.msg import CostmapMetaData
    from std_msgs.msg import Header

    data = array("B")
    data.frombytes(np.ascontiguousarray(costmap.costs).tobytes())
    metadata = CostmapMetaData(
        map_load_time=stamp,
        update_time=stamp if updated is None else updated,
        layer="master",
        resolution=costmap.resolution,
        size_x=costmap.width,
        size_y=costmap.height,
        origin=pose_message((*costmap.origin, 0.0)),
    )
    return CostmapMessage(header=Header(frame_id=frame, stamp=stamp), metadata=metadata, data=data)


def costmap_of(message: Any) -> Costmap:
    """Return the costmap that a ``nav2_msgs/msg/Costmap`` holds."""
    metadata = message.metadata
    costs = np.frombuffer(message.data, dtype=np.uint8).reshape(metadata.size_y, metadata.size_x)
    origin = (metadata.origin.position.x, metadata.origin.position.y)
    return Costmap(costs.copy(), metadata.resolution, origin)


def footprint_message(footprint: Footprint, pose: Any, frame: str, stamp: Any) -> Any:
    """Return a ``geometry_msgs/msg/PolygonStamped`` of a footprint at a pose (x [m], y [m], yaw [rad])."""
    from geometry_msgs.msg import Point32, Polygon, PolygonStamped
    from std_msgs.msg import Header

    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    corners = footprint.polygon @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
    points = [Point32(x=float(x), y=float(y), z=0.0) for x, y in corners]
    return PolygonStamped(header=Header(frame_id=frame, stamp=stamp), polygon=Polygon(points=points))


def voxel_message(grid: VoxelGrid, frame: str, stamp: Any) -> Any:
    """Return a ``nav2_msgs/msg/VoxelGrid``: occupied voxels in the upper 16 bits of a cell, unknown in the lower."""
    from geometry_msgs.msg import Point32, Vector3
    from nav2_msgs.msg import VoxelGrid as VoxelMessage
    from std_msgs.msg import Header

    data = array("I")
    data.frombytes((grid.marked.astype(np.uint32) << 16 | grid.unknown).tobytes())
    x, y, z = (float(value) for value in grid.origin)
    return VoxelMessage(
        header=Header(frame_id=frame, stamp=stamp),
        data=data,
        origin=Point32(x=x, y=y, z=z),
        resolutions=Vector3(x=grid.resolution, y=grid.resolution, z=grid.height),
        size_x=grid.marked.shape[1],
        size_y=grid.marked.shape[0],
        size_z=grid.levels,
    )
