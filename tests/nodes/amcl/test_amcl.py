"""AMCL under its ROS 1 name, with the parameters of a course's launch file."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseArray
from nav_msgs.srv import GetMap, SetMap
from rcl_interfaces.msg import Log
from rclpy.node import Node
from std_srvs.srv import Empty

from daidalos.mapping.grid import OccupancyGrid
from daidalos.nodes.amcl._parameters import Ros1AmclParameters
from daidalos.nodes.amcl.amcl import Amcl
from daidalos.nodes.conversions import grid_message
from nodes.localizing import MAP, START, Walk, compiled
from nodes.stepped import Stage

__all__ = ["compiled"]
pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]
COURSE = {
    "odom_model_type": "diff-corrected", "odom_alpha5": 0.1, "transform_tolerance": 0.2, "gui_publish_rate": 4,
    "laser_max_beams": 30, "min_particles": 200, "max_particles": 2000, "kld_err": 0.05, "kld_z": 0.99,
    "odom_alpha1": 0.2, "odom_alpha2": 0.2, "odom_alpha3": 0.8, "odom_alpha4": 0.2, "laser_z_hit": 0.5,
    "laser_z_short": 0.05, "laser_z_max": 0.05, "laser_z_rand": 0.5, "laser_sigma_hit": 0.2, "laser_lambda_short": 0.1,
    "laser_model_type": "likelihood_field", "odom_frame_id": "odom", "base_frame_id": "base_footprint",
    "global_frame_id": "map", "tf_broadcast": True, "laser_likelihood_max_dist": 2, "update_min_d": 0.002,
    "update_min_a": 0.005, "resample_interval": 1, "recovery_alpha_slow": 0.002, "recovery_alpha_fast": 0.1,
}  # fmt: skip


@pytest.mark.slow
def test_the_courses_parameters_localize_a_robot(stage: Callable[[dict[str, Any]], Stage]) -> None:
    set_stage = stage({"/amcl": {**COURSE, "force_update_after_initialpose": True}})
    log = set_stage.collect(Log, "/rosout", 100)
    set_stage.add(Amcl())
    walk = Walk(set_stage)
    arrays = set_stage.collect(PoseArray, "particlecloud")
    walk.publish_map()
    set_stage.step()
    assert any("without effect: force_update_after_initialpose" in one.msg for one in log)
    walk.guess(START + np.array([0.3, 0.3, -0.2]))
    for _ in range(8):
        walk.look()
    assert walk.error()[0] < 0.1
    walk.walk(20)
    assert walk.error()[0] < 0.15
    # The particles come at gui_publish_rate at most, the poses with each update.
    assert 0 < len(arrays) < len(walk.poses)
    # The map of the topic was the first one; another one comes by the service only.
    other = OccupancyGrid(np.flipud(MAP.data), MAP.resolution, MAP.origin)
    walk.publish_map(other)
    walk.look()
    assert walk.error()[0] < 0.15
    message = grid_message(MAP.data, MAP.resolution, MAP.origin[:2], "map", set_stage.stamp)
    assert set_stage.call(SetMap, "set_map", map=message, initial_pose=walk.poses[-1]).success
    message.data = message.data[:-1]
    assert not set_stage.call(SetMap, "set_map", map=message).success
    set_stage.call(Empty, "request_nomotion_update")
    walk.look()
    assert walk.error()[0] < 0.15
    set_stage.call(Empty, "global_localization")
    walk.look()
    assert walk.poses[-1].pose.covariance[0] > 0.3


def test_the_map_comes_from_a_service_and_the_pose_from_parameters(stage: Callable[[dict[str, Any]], Stage]) -> None:
    pose = {f"initial_pose_{name}": float(value) for name, value in zip("xya", START, strict=True)}
    set_stage = stage({"/amcl": {"base_frame_id": "base_footprint", "save_pose_rate": 2, **pose}})

    def serve(request: Any, response: Any) -> Any:
        response.map = grid_message(MAP.data, MAP.resolution, MAP.origin[:2], "map", set_stage.stamp)
        return response

    server: Node = set_stage.node
    server.create_service(GetMap, "static_map", serve)
    node = set_stage.add(Amcl())
    walk = Walk(set_stage)
    while not walk.map_to_odom:
        walk.look()
    for _ in range(5):
        walk.look()
    assert walk.error()[0] < 0.1
    set_stage.step_until(lambda: node.get_parameter("initial_cov_xx").value != 0.25)


def test_ros_1s_defaults_and_names() -> None:
    values = Ros1AmclParameters(odom_model_type="omni", laser_z_hit=0.7, kld_err=0.02, use_map_topic=True).for_nav2()
    assert (values.robot_model_type, values.z_hit, values.pf_err) == ("omni", 0.7, 0.02)
    assert (values.max_particles, values.max_beams, values.laser_max_range) == (5000, 30, -1.0)
    assert not values.first_map_only
