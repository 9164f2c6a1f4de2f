"""`amcl`: localizes a robot in a map, with ROS 1's parameters, topics and services."""

from __future__ import annotations

from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.nodes.amcl._parameters import Ros1AmclParameters
from daidalos.nodes.conversions import pose2_of, pose_message
from daidalos.nodes.nav2_amcl._localizer import Localizer
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.runner import run

_MAP_PERIOD = 1.0
_WITHOUT_EFFECT = {
    "force_update_after_initialpose": "scans after an initial pose are always used",
    "force_update_after_set_map": "the scan after a new map is always used",
    "restore_defaults": "defaults are restored by starting the node without parameters",
    "std_warn_level_x": "there are no diagnostics of the spread",
    "std_warn_level_y": "there are no diagnostics of the spread",
    "std_warn_level_yaw": "there are no diagnostics of the spread",
    "bag_scan_period": "bags are played with ros2 bag play",
}
"""Parameters of some of ROS 1's releases that do nothing here, with the reason."""


class Amcl(Node):
    """Node that localizes from its start, at the pose that its parameters give.

    Its parameters are those of `Ros1AmclParameters`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("amcl", **kwargs)
        from nav_msgs.srv import GetMap, SetMap
        from std_srvs.srv import Empty

        self._settings = p = declare(self, Ros1AmclParameters, reconfigure=self._reconfigure)
        declare_without_effect(self, _WITHOUT_EFFECT)
        self._localizer = Localizer(self, p.for_nav2(), lambda: True)
        self._limit_particles()
        self._localizer.take_initial_pose(self._initial_pose())
        self.create_service(Empty, "global_localization", self._on_global_localization)
        self.create_service(Empty, "request_nomotion_update", self._on_nomotion_update)
        self.create_service(SetMap, "set_map", self._on_set_map)
        if not p.use_map_topic:
            self._map_client = self.create_client(GetMap, "static_map")
            self._map_timer = self.create_timer(_MAP_PERIOD, self._ask_for_map)
        if p.save_pose_rate > 0.0:
            self.create_timer(1.0 / p.save_pose_rate, self._save_pose)

    def _reconfigure(self, parameters: Ros1AmclParameters) -> None:
        self._settings = parameters
        self._localizer.reconfigure(parameters.for_nav2())
        self._limit_particles()

    def _limit_particles(self) -> None:
        rate = self._settings.gui_publish_rate
        self._localizer.particles_wait_ns = round(1e9 / rate) if rate > 0.0 else 0

    def _initial_pose(self) -> Any:
        from geometry_msgs.msg import PoseWithCovariance, PoseWithCovarianceStamped
        from std_msgs.msg import Header

        p = self._settings
        covariance = np.zeros((6, 6))
        covariance[0, 0], covariance[1, 1], covariance[5, 5] = p.initial_cov_xx, p.initial_cov_yy, p.initial_cov_aa
        pose = pose_message((p.initial_pose_x, p.initial_pose_y, p.initial_pose_a))
        return PoseWithCovarianceStamped(
            header=Header(frame_id=p.global_frame_id), pose=PoseWithCovariance(pose=pose, covariance=covariance.ravel())
        )

    async def _ask_for_map(self) -> None:
        """Ask the server of `map_server` for the map, until there is one."""
        from nav_msgs.srv import GetMap

        if self._localizer.has_map:
            self.destroy_timer(self._map_timer)
        elif self._map_client.service_is_ready():
            answer = await self._map_client.call_async(GetMap.Request())
            if answer.map.data and not self._localizer.has_map:
                self._localizer.take_map(answer.map)

    def _save_pose(self) -> None:
        message = self._localizer.last_pose
        covariance = np.array(message.pose.covariance).reshape(6, 6).diagonal()[[0, 1, 5]]
        values = [*pose2_of(message.pose.pose).tolist(), *covariance.tolist()]
        names = ("pose_x", "pose_y", "pose_a", "cov_xx", "cov_yy", "cov_aa")
        self.set_parameters([Parameter(f"initial_{n}", value=value) for n, value in zip(names, values, strict=True)])

    def _on_global_localization(self, request: Any, response: Any) -> Any:
        self._localizer.take_global_localization()
        return response

    def _on_nomotion_update(self, request: Any, response: Any) -> Any:
        self._localizer.request_update()
        return response

    def _on_set_map(self, request: Any, response: Any) -> Any:
        response.success = self._localizer.take_map(request.map, replace=True)
        if response.success:
            self._localizer.take_initial_pose(request.initial_pose)
        return response


def main() -> int:
    """Run the node."""
    return run(Amcl)
