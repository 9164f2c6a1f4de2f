"""Which servers the launch files of navigation start."""

from pathlib import Path

import numpy as np
import pytest
from launch import LaunchContext
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions import Node

from daidalos.cli.ros2 import main
from daidalos.description import sdf
from daidalos.mapping.map_file import load_map

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


def test_the_map_of_the_depot_is_that_of_its_world() -> None:
    world = sdf.load(FOLDER.parents[1] / "nav2_minimal_tb4_sim" / "worlds" / "depot.sdf")
    grid = load_map(FOLDER.parent / "maps" / "depot.yaml")
    occupied = np.zeros(grid.data.shape, dtype=bool)
    height, width = occupied.shape
    x, y = (grid.origin[axis] + grid.resolution * (np.arange(n) + 0.5) for axis, n in ((0, width), (1, height)))
    for model in world.models:
        for collision in model.links["link"].collisions if model.name != "ground_plane" else ():
            (cx, cy, _), (length, depth, _) = collision.pose.position, collision.geometry.size
            across = np.abs(x - cx) <= 0.5 * length + 1e-6
            occupied |= (np.abs(y - cy) <= 0.5 * depth + 1e-6)[:, None] & across
    assert np.array_equal(grid.data == 100, occupied)


@pytest.mark.parametrize("name", ["tb4_simulation_launch.py", "tb4_loopback_simulation.launch.py"])
def test_the_tb4_launch_files_have_arguments_of_their_own(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "nav2_bringup", name, "--show-args"]) in (0, None)
    written = capsys.readouterr().out
    assert "depot.yaml" in written
    for argument in ("map", "namespace", "params_file", "autostart", "use_composition", "use_rviz"):
        assert f"'{argument}'" in written
