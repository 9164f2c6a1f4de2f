"""Conversion of costmaps and footprints to and from messages."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.nodes.conversions import pose_message


def costmap_message(costmap: Costmap, frame: str, stamp: Any) -> Any:
    """Return a ``nav2_msgs/msg/Costmap``: the costs themselves, without a loss."""
    from nav2_msgs.msg import Costmap as CostmapMessage
    from nav2_msgs.msg import CostmapMetaData
    from std_msgs.msg import Header

    data = array("B")
    data.frombytes(np.ascontiguousarray(costmap.costs).tobytes())
    metadata = CostmapMetaData(
        map_load_time=stamp,
        update_time=stamp,
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
