"""The launch file and parameter files of a ROS 1 workshop for `move_base`, in the arena, in lock-step."""

from __future__ import annotations

import math
import os
import threading
from pathlib import Path
from typing import Any

import pytest
from nav2_msgs.action import NavigateToPose

from daidalos.mapping.map_file import save_map
from daidalos.nodes.conversions import pose_stamped
from daidalos.samples.fields import time_message
from daidalos.testing.network import Network
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.worlds import Robot, World
from end_to_end.test_localization_failures import ARENA, map_of
from end_to_end.test_navigation_failures import BLIND_M

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]

LAUNCH = """<launch>
  <param name="/use_sim_time" value="true"/>
  <node name="map_server" pkg="map_server" type="map_server" args="{map}"/>
  <node pkg="amcl" type="amcl" name="amcl">
    <param name="odom_frame_id" value="odom"/>
    <param name="base_frame_id" value="base_footprint"/>
    <param name="min_particles" value="200"/>
    <param name="laser_max_beams" value="30"/>
  </node>
  <node pkg="move_base" type="move_base" respawn="false" name="move_base" output="screen">
    <param name="base_local_planner" value="{controller}"/>
    <param name="base_global_planner" value="global_planner/GlobalPlanner"/>
    <rosparam file="{cfg}/costmap_common_params.yaml" command="load" ns="global_costmap" />
    <rosparam file="{cfg}/costmap_common_params.yaml" command="load" ns="local_costmap" />
    <rosparam file="{cfg}/global_costmap_params.yaml" command="load" />
    <rosparam file="{cfg}/local_costmap_params.yaml" command="load" />
    <rosparam file="{cfg}/global_planner_params.yaml" command="load" />
    <rosparam file="{cfg}/local_planner_params.yaml" command="load" />
    <rosparam file="{cfg}/move_base_params.yaml" command="load"/>
  </node>
</launch>
"""
FILES = {
    "costmap_common": """
obstacle_range: 3.0
raytrace_range: 3.5
footprint: [[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]]
inflation_radius: 0.5
cost_scaling_factor: 3.0
map_type: costmap
observation_sources: scan
scan: {sensor_frame: base_scan, data_type: LaserScan, topic: scan, marking: true, clearing: true}
""",
    "global_costmap": """
global_costmap:
  global_frame: map
  robot_base_frame: base_footprint
  update_frequency: 10.0
  publish_frequency: 1
  transform_tolerance: 0.5
  static_map: true
""",
    "local_costmap": """
local_costmap:
  global_frame: odom
  robot_base_frame: base_footprint
  update_frequency: 10.0
  publish_frequency: 5
  transform_tolerance: 0.5
  static_map: false
  rolling_window: true
  width: 4
  height: 4
  resolution: 0.05
""",
    "global_planner": """
GlobalPlanner: {allow_unknown: true, default_tolerance: 0.2, use_dijkstra: true, neutral_cost: 66, cost_factor: 0.55}
""",
    "move_base": """
shutdown_costmaps: false
controller_frequency: 10.0
planner_patience: 5.0
controller_patience: 15.0
conservative_reset_dist: 3.0
planner_frequency: 1
oscillation_timeout: 10.0
oscillation_distance: 0.2
""",
}
CONTROLLERS = {
    "teb_local_planner/TebLocalPlannerROS": """
TebLocalPlannerROS:
  odom_topic: odom
  max_vel_x: 0.26
  max_vel_x_backwards: 0.1
  max_vel_theta: 1.0
  acc_lim_x: 1.0
  acc_lim_theta: 2.0
  footprint_model: {type: polygon, vertices: [[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]]}
  xy_goal_tolerance: 0.15
  yaw_goal_tolerance: 0.2
  min_obstacle_dist: 0.1
  inflation_dist: 0.3
  costmap_converter_plugin: ""
""",
    "dwa_local_planner/DWAPlannerROS": """
DWAPlannerROS:
  max_vel_x: 0.26
  min_vel_x: 0.0
  max_vel_trans: 0.26
  min_vel_trans: 0.0
  max_vel_theta: 1.0
  acc_lim_x: 2.5
  acc_lim_theta: 3.2
  xy_goal_tolerance: 0.15
  yaw_goal_tolerance: 0.2
  sim_time: 1.7
  vx_samples: 10
  vth_samples: 20
""",
}


@pytest.fixture
def move_base(world: World, launch: Any, transform: Any, tmp_path: Path) -> Any:
    def start(controller: str) -> Robot:
        map_file, _ = save_map(map_of(ARENA), tmp_path / "arena")
        for name, text in {**FILES, "local_planner": CONTROLLERS[controller]}.items():
            (tmp_path / f"{name}_params.yaml").write_text(text)
        file = tmp_path / "move_base.launch"
        file.write_text(LAUNCH.format(map=map_file, cfg=tmp_path, controller=controller))
        launch("turtlebot3_gazebo", "turtlebot3_arena.launch.py")
        launch(file)
        robot = world.wait_for("waffle")
        robot.never_touches()
        transform("map", "base_footprint").wait(60.0)
        return robot

    return start


@pytest.mark.scenario(timeout=200, seed=1)
@pytest.mark.parametrize("controller", sorted(CONTROLLERS))
def test_goals_in_the_arena_are_reached(move_base: Any, action: Any, controller: str) -> None:
    robot = move_base(controller)
    go = action("/move_base", NavigateToPose)
    for x, y, yaw in ((2.0, 0.0, 0.0), (-1.5, -1.5, 1.5)):
        go.send_goal(NavigateToPose.Goal(pose=pose_stamped((x, y, yaw), "map", time_message(0))), within=90.0)
        assert math.dist((robot.position.x, robot.position.y), (x, y)) < 0.3


@pytest.mark.scenario(timeout=120, seed=1)
def test_the_robot_stands_while_scans_are_missing(
    move_base: Any, action: Any, network: Network, clock: Scenario
) -> None:
    robot = move_base("teb_local_planner/TebLocalPlannerROS")
    go, failures = action("/move_base", NavigateToPose), []

    def drive() -> None:
        try:
            goal = pose_stamped((2.0, 0.0, 0.0), "map", time_message(0))
            go.send_goal(NavigateToPose.Goal(pose=goal), within=100.0)
        except ScenarioFailure as failure:
            failures.append(str(failure))

    thread = threading.Thread(target=drive)
    thread.start()
    robot.speed.eventually(above=0.15, within=30.0)
    network.drop_out("/scan", 5.0)
    begun = robot.position.x, robot.position.y
    clock.sleep(4.5)
    assert math.dist(begun, (robot.position.x, robot.position.y)) < BLIND_M
    thread.join()
    assert failures == []
