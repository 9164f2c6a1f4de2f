"""Which servers the launch files of navigation start."""

from pathlib import Path

import pytest
from launch import LaunchContext
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node

LAUNCH = Path(__file__).parents[2] / "src" / "daidalos" / "share" / "nav2_bringup" / "launch" / "navigation_launch.py"
ALWAYS = {
    "controller_server",
    "smoother_server",
    "planner_server",
    "behavior_server",
    "velocity_smoother",
    "collision_monitor",
    "bt_navigator",
    "waypoint_follower",
}


@pytest.mark.parametrize(
    ("parameters", "graph", "more"),
    [
        ("planner_server: {ros__parameters: {}}", "", set()),
        ("docking_server:\n  ros__parameters: {dock_plugins: []}", "", {"opennav_docking"}),
        ("robot:\n  route_server: {ros__parameters: {}}", "", {"route_server"}),
        ("/robot/docking_server:\n  ros__parameters: {}", "", {"opennav_docking"}),
        ("bt_navigator:\n  ros__parameters: {docking_server_name: x}", "", set()),
        ("# docking_server:", "", set()),
        ("", "graph.geojson", {"route_server"}),
    ],
)
def test_servers_that_not_all_robots_need_are_started_where_the_parameters_name_them(
    tmp_path: Path, parameters: str, graph: str, more: set[str]
) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(parameters)
    context = LaunchContext()
    context.launch_configurations.update(params_file=str(file), graph=graph, use_composition="False")
    described = PythonLaunchDescriptionSource(str(LAUNCH)).get_launch_description(context)
    started: set[str] = set()
    for action in described.entities:
        if isinstance(action, DeclareLaunchArgument):
            action.execute(context)
        elif isinstance(action, OpaqueFunction):
            for node in action.execute(context):
                if isinstance(node, Node):
                    started.add(
                        perform_substitutions(context, normalize_to_list_of_substitutions(node.node_executable))
                    )
    assert started == ALWAYS | more | {"lifecycle_manager"}
