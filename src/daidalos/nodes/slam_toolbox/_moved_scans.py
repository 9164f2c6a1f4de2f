"""Key scans that people move by hand: the interactive mode of slam_toolbox's nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.nodes.conversions import pose2_of, transform_stamped
from daidalos.nodes.slam_toolbox._graph_markers import MovableScans

if TYPE_CHECKING:
    from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox


class MovedScans:
    """Services and markers by which key scans are moved.

    Parameters
    ----------
    node
        Has the map.
    """

    def __init__(self, node: SlamToolbox) -> None:
        from sensor_msgs.msg import LaserScan
        from slam_toolbox.srv import Clear, LoopClosure, ToggleInteractive
        from tf2_ros import TransformBroadcaster

        self._node = node
        self._moved: dict[int, Any] = {}
        node.create_service(Clear, "slam_toolbox/clear_changes", self._on_clear_changes)
        node.create_service(LoopClosure, "slam_toolbox/manual_loop_closure", self._on_manual_closure)
        node.create_service(ToggleInteractive, "slam_toolbox/toggle_interactive_mode", self._on_toggle_interactive)
        self._scan_publisher = node.create_publisher(LaserScan, "slam_toolbox/scan_visualization", 10)
        self._broadcaster = TransformBroadcaster(node)
        self._markers = MovableScans(node, node.settings.map_frame, self._on_moved, self._on_dragged)

    @property
    def moved(self) -> dict[int, Any]:
        """The planar poses of the key scans that were moved and not yet applied, by their indices."""
        return self._moved

    def forget(self) -> None:
        """Forget what was moved."""
        self._moved.clear()

    def close(self) -> None:
        """End the service of markers."""
        self._markers.shutdown()

    def _is_allowed(self) -> bool:
        """Return whether key scans may be moved by hand, after a warning where not."""
        if self._node.settings.enable_interactive_mode and self._node.allows_interaction():
            return True
        self._node.get_logger().warning("the interactive mode is disabled, the request is ignored")
        return False

    def _on_toggle_interactive(self, request: Any, response: Any) -> Any:
        if self._is_allowed():
            on = not self._node.is_set("interactive_mode")
            self._node.set_flag("interactive_mode", on)
            self._node.set_flag("paused_processing", on)
            self._moved.clear()
            self._show()
            self._node.get_logger().info(f"the interactive mode is {'on' if on else 'off'}")
            if not on:
                self._node.resume()
        return response

    def _show(self) -> None:
        """Offer the key scans to be moved while the interactive mode is on, and publish the edges."""
        node = self._node
        if node.slam is None:
            return
        with node.lock:
            poses = node.slam.key_poses
        is_on = node.is_set("interactive_mode")
        self._markers.show(poses if is_on else poses[:0], node.get_clock().now().to_msg())
        node.publish_graph(with_scans=not is_on)

    def _on_moved(self, index: int, pose: Any) -> None:
        self._moved[index] = pose2_of(pose)
        self._node.get_logger().info(f"key scan {index} was moved; slam_toolbox/manual_loop_closure applies it")

    def _on_dragged(self, index: int, pose: Any) -> None:
        """Show a key scan where it is dragged to."""
        from sensor_msgs.msg import LaserScan

        with self._node.lock:
            if not 0 <= index < self._node.slam.key_count:
                return
            points = self._node.slam.key_clouds[index].ends
        angles = np.arctan2(points[:, 1], points[:, 0])
        count = 720
        ranges = np.full(count, np.inf, np.float32)
        beams = ((angles + np.pi) / (2 * np.pi) * count).astype(int) % count
        np.minimum.at(ranges, beams, np.hypot(*points.T).astype(np.float32))
        stamp = self._node.get_clock().now().to_msg()
        frame = "scan_visualization"
        self._broadcaster.sendTransform(transform_stamped(pose2_of(pose), self._node.settings.map_frame, frame, stamp))
        scan = LaserScan(angle_min=-np.pi, angle_max=np.pi, angle_increment=2 * np.pi / count, range_max=1e3)
        scan.header.stamp, scan.header.frame_id, scan.ranges = stamp, frame, ranges
        self._scan_publisher.publish(scan)

    def _on_manual_closure(self, request: Any, response: Any) -> Any:
        if not self._is_allowed():
            return response
        if not self._moved:
            self._node.get_logger().warning("no key scan was moved")
            return response
        with self._node.lock:
            self._node.slam.move_keys(self._moved)
            self._node.map_to_odom = self._node.slam.map_to_odom
        self._node.get_logger().info(f"optimized the graph with {len(self._moved)} key scans moved by hand")
        self._moved.clear()
        self._node.drawn_keys = -1
        self._show()
        return response

    def _on_clear_changes(self, request: Any, response: Any) -> Any:
        if self._is_allowed():
            self._moved.clear()
            self._show()
        return response
