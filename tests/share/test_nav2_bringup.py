"""Which servers the launch files of navigation start."""

from pathlib import Path

import pytest
from launch import LaunchContext
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node

FOLDER = Path(__file__).parents[2] / "src" / "daidalos" / "share" / "nav2_bringup" / "launch"
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
        ("following_server:\n  ros__parameters: {}", "", {"opennav_following"}),
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
    started = [node.node_executable for node in started_by("navigation_launch.py", context)]
    names = {perform_substitutions(context, normalize_to_list_of_substitutions(name)) for name in started}
    assert names == ALWAYS | more | {"lifecycle_manager"}


@pytest.mark.parametrize("zone", ["keepout", "speed"])
def test_the_servers_of_a_zone_have_the_names_of_parameter_files(tmp_path: Path, zone: str) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(f"{zone}_filter_mask_server: {{ros__parameters: {{topic_name: mask}}}}")
    context = LaunchContext()
    context.launch_configurations.update(params_file=str(file), zone=zone, mask="mask.yaml", use_composition="False")
    started = started_by("zone_launch.py", context)
    for node in started:
        node._perform_substitutions(context)
    assert [node.node_name for node in started] == [
        f"/{zone}_filter_mask_server",
        f"/{zone}_costmap_filter_info_server",
        f"/lifecycle_manager_{zone}_zone",
    ]


def started_by(name: str, context: LaunchContext) -> list[Node]:
    """Return the nodes that a launch file starts each in a process."""
    started: list[Node] = []
    for action in PythonLaunchDescriptionSource(str(FOLDER / name)).get_launch_description(context).entities:
        if isinstance(action, DeclareLaunchArgument):
            action.execute(context)
        elif isinstance(action, OpaqueFunction):
            started += [node for node in action.execute(context) if isinstance(node, Node)]
    return started
