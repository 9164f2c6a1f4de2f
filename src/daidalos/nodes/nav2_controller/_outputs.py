"""What controllers show of a cycle, as messages."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from rclpy.node import Node

from daidalos.navigation.contracts import Candidates, Output
from daidalos.nodes.conversions import path_message

_WIDTH_M = 0.01


class ControllerOutputs:
    """Publishers of the outputs of a server's controllers; those of the same topic share one.

    Parameters
    ----------
    node : Node
    outputs : sequence of (str, Output)
        With the names of their controllers.
    """

    def __init__(self, node: Node, outputs: Sequence[tuple[str, Output]]) -> None:
        from nav_msgs.msg import Path
        from visualization_msgs.msg import MarkerArray

        self._node = node
        kinds: dict[type, Any] = {Candidates: MarkerArray, np.ndarray: Path}
        publishers: dict[str, Any] = {}
        self._outputs: list[tuple[str, Output, Any]] = []
        for name, output in outputs:
            if output.topic not in publishers:
                publishers[output.topic] = node.create_publisher(kinds[output.type], output.topic, 1)
            self._outputs.append((name, output, publishers[output.topic]))

    def publish(self, controller: str, frame: str) -> None:
        """Publish what a controller shows of its last cycle, as far as there are subscribers."""
        stamp = self._node.get_clock().now().to_msg()
        for name, output, publisher in self._outputs:
            if name != controller or not publisher.handle.has_subscribers:
                continue
            value = output.give()
            if value is None:
                continue
            make = marker_message if output.type is Candidates else path_message
            publisher.publish(make(value, frame, stamp))


def marker_message(candidates: Candidates, frame: str, stamp: Any) -> Any:
    """Return trajectories as one ``visualization_msgs/msg/Marker`` of lines, from green for the best to red."""
    from geometry_msgs.msg import Point
    from std_msgs.msg import ColorRGBA
    from visualization_msgs.msg import Marker, MarkerArray

    marker = Marker(type=Marker.LINE_LIST, action=Marker.ADD, ns="candidate_trajectories")
    marker.header.frame_id, marker.header.stamp = frame, stamp
    marker.pose.orientation.w, marker.scale.x = 1.0, _WIDTH_M
    for points, shade in zip(candidates.points.tolist(), shades(candidates.costs).tolist(), strict=True):
        corners = [Point(x=x, y=y) for x, y in points]
        lines = [corner for pair in pairwise(corners) for corner in pair]
        marker.points.extend(lines)
        marker.colors.extend([ColorRGBA(r=shade, g=1.0 - shade, a=0.5)] * len(lines))
    return MarkerArray(markers=[marker])


def shades(costs: Any) -> Any:
    """Return the rank of each cost among all, from 0 for the least to 1; costs of contact would hide any difference."""
    ranks = np.empty(costs.size)
    ranks[np.argsort(costs, kind="stable")] = np.linspace(0.0, 1.0, costs.size)
    return ranks
