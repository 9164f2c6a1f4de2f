"""Spawns one entity, and starts a bridge for it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

BRIDGE = ("bridge_name", "config_file")


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("bridge_name", default_value="ros_gz_bridge", description="name of the bridge"),
            DeclareLaunchArgument("config_file", description="YAML file with the bridges"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_spawn_model.launch.py"])
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("ros_gz_bridge"), "launch", "ros_gz_bridge.launch.py"]),
                launch_arguments=[(name, LaunchConfiguration(name)) for name in BRIDGE],
            ),
        ]
    )
