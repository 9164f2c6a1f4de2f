"""Mapping while driving: slam_toolbox, and the server that saves its map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.descriptions import ParameterFile
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import HasNodeParams, RewrittenYaml

ARGUMENTS = [
    ("namespace", "", "namespace of all nodes"),
    ("use_sim_time", "true", "whether the simulator's clock is used"),
    ("autostart", "true", "whether the nodes are activated at once"),
    ("use_respawn", "True", "whether a process that ends is started again"),
    ("log_level", "info", "log level"),
]


def generate_launch_description():
    value = LaunchConfiguration
    default = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    file = RewrittenYaml(
        source_file=value("params_file"), root_key=value("namespace"), param_rewrites={}, convert_types=True
    )
    clock = {"use_sim_time": value("use_sim_time")}
    common = {
        "namespace": value("namespace"),
        "output": "screen",
        "respawn": value("use_respawn"),
        "respawn_delay": 2.0,
        "arguments": ["--ros-args", "--log-level", value("log_level")],
    }
    slam = PathJoinSubstitution([FindPackageShare("slam_toolbox"), "launch", "online_sync_launch.py"])
    is_given = HasNodeParams(source_file=value("params_file"), node_name="slam_toolbox")
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in ARGUMENTS),
            DeclareLaunchArgument("params_file", default_value=default, description="parameter file"),
            Node(
                package="nav2_map_server",
                executable="map_saver_server",
                parameters=[ParameterFile(file, allow_substs=True), clock],
                **common,
            ),
            Node(
                package="nav2_lifecycle_manager",
                executable="lifecycle_manager",
                name="lifecycle_manager_slam",
                parameters=[clock, {"autostart": value("autostart"), "node_names": ["map_saver"]}],
                **common,
            ),
            IncludeLaunchDescription(slam, launch_arguments=clock.items(), condition=UnlessCondition(is_given)),
            IncludeLaunchDescription(
                slam,
                launch_arguments={**clock, "slam_params_file": value("params_file")}.items(),
                condition=IfCondition(is_given),
            ),
        ]
    )
