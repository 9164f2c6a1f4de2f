"""What localizing nodes add to mapping ones: first poses, the buffer of latest scans, and refusals."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.conversions import pose2_of
from daidalos.nodes.slam_toolbox._slam_toolbox import SlamToolbox


class LocalizingSlamToolbox(SlamToolbox):
    """Base of nodes that can localize the robot in a saved map, which then stays as it is.

    Attributes
    ----------
    localizing : bool
        Whether it does so now.
    """

    localizing = True

    def configure(self) -> None:
        """Listen to ``initialpose`` as well, and serve the buffer of latest scans."""
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from std_srvs.srv import Empty

        super().configure()
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 1)
        self.create_service(Empty, "slam_toolbox/clear_localization_buffer", self._on_clear_buffer)

    def new_slam(self, saved: Any = None) -> Any:
        slam = super().new_slam(saved)
        slam.localizing = self.localizing
        return slam

    def allows_interaction(self) -> bool:
        return False

    def refusal_to_save(self) -> str:
        return "a node that localizes does not change its map" if self.localizing else ""

    def refusal_to_load(self, request: Any) -> str:
        if not self.localizing:
            return super().refusal_to_load(request)
        if request.match_type == request.LOCALIZE_AT_POSE:
            return ""
        return f"expected match_type 3 (LOCALIZE_AT_POSE) while localizing, found {request.match_type}"

    def _on_initial_pose(self, message: Any) -> None:
        frame = message.header.frame_id or self.settings.map_frame
        if not self.localizing:
            self.get_logger().warning("a pose on initialpose is ignored: the node maps, it does not localize")
        elif frame != self.settings.map_frame:
            self.get_logger().error(f"expected a pose in '{self.settings.map_frame}' on initialpose, found '{frame}'")
        elif self.slam is None or not self.slam.key_count:
            self.get_logger().error("a pose on initialpose is ignored: there is no map yet")
        else:
            pose = pose2_of(message.pose.pose)
            with self.lock:
                self.slam.start_at(pose)
            self.get_logger().info(f"localizing at ({pose[0]:.2f}, {pose[1]:.2f}), heading {pose[2]:.2f}")

    def _on_clear_buffer(self, request: Any, response: Any) -> Any:
        if self.slam is not None:
            with self.lock:
                self.slam.forget_recent()
        self.get_logger().info("forgot the latest scans")
        return response
