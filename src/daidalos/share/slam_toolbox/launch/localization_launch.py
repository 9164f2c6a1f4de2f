"""Localization in a saved map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("slam_toolbox")
    parameters = PathJoinSubstitution([share, "config", "mapper_params_localization.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="whether time is simulated"),
            DeclareLaunchArgument("slam_params_file", default_value=parameters, description="parameter file"),
            IncludeLaunchDescription(
                PathJoinSubstitution([share, "launch", "slam_toolbox_node_launch.py"]),
                launch_arguments={
                    "executable": "localization_slam_toolbox_node",
                    "use_sim_time": LaunchConfiguration("use_sim_time"),
                    "slam_params_file": LaunchConfiguration("slam_params_file"),
                }.items(),
            ),
        ]
    )
