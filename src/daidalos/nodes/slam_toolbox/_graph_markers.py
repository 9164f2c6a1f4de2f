"""The pose graph as markers: key scans as spheres, edges as lines; the scans can be moved by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.common.arrays import Array
from daidalos.nodes.conversions import pose_message

if TYPE_CHECKING:
    from collections.abc import Callable

    from interactive_markers import InteractiveMarkerServer
    from rclpy.node import Node

NAMESPACE = "slam_toolbox"
_KEY_SCAN_SIZE, _EDGE_WIDTH = 0.1, 0.05


def graph_markers(poses: Array, edges: Any, frame: str, stamp: Any, *, with_scans: bool) -> Any:
    """Return a pose graph as ``visualization_msgs/msg/MarkerArray``, beginning with a marker that deletes older ones.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        Of the key scans.
    edges : sequence of Edge
        Between them; closures have another color.
    frame, stamp
        Of the markers.
    with_scans : bool
        Whether there is a sphere for each key scan.
    """
    from geometry_msgs.msg import Point
    from std_msgs.msg import Header
    from visualization_msgs.msg import Marker, MarkerArray

    header = Header(frame_id=frame, stamp=stamp)
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    for index, pose in enumerate(poses if with_scans else ()):
        markers.append(sphere(index, pose, frame, stamp))
    for identifier, is_closure, color in ((0, False, (0.0, 0.0, 1.0)), (1, True, (0.0, 1.0, 1.0))):
        lines = Marker(header=header, ns=f"{NAMESPACE}_edges", id=identifier, type=Marker.LINE_LIST)
        lines.pose.orientation.w = 1.0
        lines.scale.x = _EDGE_WIDTH
        lines.color.r, lines.color.g, lines.color.b = color
        lines.color.a = 1.0
        lines.points = [
            Point(x=float(poses[end][0]), y=float(poses[end][1]), z=0.0)
            for edge in edges
            if edge.closure == is_closure
            for end in (edge.first, edge.second)
        ]
        markers.append(lines)
    return MarkerArray(markers=markers)


def sphere(identifier: int, pose: Array, frame: str, stamp: Any, size: float = _KEY_SCAN_SIZE) -> Any:
    """Return a key scan as a marker."""
    from std_msgs.msg import Header
    from visualization_msgs.msg import Marker

    marker = Marker(header=Header(frame_id=frame, stamp=stamp), ns=NAMESPACE, id=identifier, type=Marker.SPHERE)
    marker.pose = pose_message(pose)
    marker.scale.x = marker.scale.y = marker.scale.z = size
    marker.color.r = marker.color.a = 1.0
    return marker


def movable(marker: Any, name: str, scale: float) -> Any:
    """Return a marker that can be moved and turned in the plane."""
    from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl

    shown = InteractiveMarkerControl(always_visible=True, markers=[marker])
    moved = InteractiveMarkerControl(name="move_plane", interaction_mode=InteractiveMarkerControl.MOVE_PLANE)
    turned = InteractiveMarkerControl(name="rotate", interaction_mode=InteractiveMarkerControl.ROTATE_AXIS)
    for control in (moved, turned):  # the axis is the z axis
        control.orientation.w, control.orientation.y = 0.7071068, 0.7071068
    found = InteractiveMarker(header=marker.header, name=name, pose=marker.pose, scale=scale)
    found.controls = [shown, moved, turned]
    return found


class MovableScans:
    """Key scans that people move by hand.

    Parameters
    ----------
    node
        Serves the markers below ``slam_toolbox``.
    frame
        Frame of the map.
    on_move
        Called with the index of a key scan and its new pose message when it is let go.
    on_drag
        Called with the same while it is moved.
    """

    def __init__(
        self, node: Node, frame: str, on_move: Callable[[int, Any], None], on_drag: Callable[[int, Any], None]
    ) -> None:
        from interactive_markers import InteractiveMarkerServer

        self._server: InteractiveMarkerServer = InteractiveMarkerServer(node, NAMESPACE)
        self._frame = frame
        self._on_move, self._on_drag = on_move, on_drag

    def show(self, poses: Array, stamp: Any) -> None:
        """Offer key scans at these poses, none where there are none."""
        self._server.clear()
        for index, pose in enumerate(poses):
            marker = sphere(index, pose, self._frame, stamp)
            marker.pose = pose_message((0.0, 0.0, 0.0))
            offered = movable(marker, str(index), 3 * _KEY_SCAN_SIZE)
            offered.pose = pose_message(pose)
            self._server.insert(offered, feedback_callback=self._on_feedback)
        self._server.applyChanges()

    def _on_feedback(self, feedback: Any) -> None:
        index = int(feedback.marker_name)
        if feedback.event_type == feedback.MOUSE_UP:
            self._on_move(index, feedback.pose)
        elif feedback.event_type == feedback.POSE_UPDATE:
            self._on_drag(index, feedback.pose)

    def shutdown(self) -> None:
        """End the service of markers."""
        self._server.shutdown()
