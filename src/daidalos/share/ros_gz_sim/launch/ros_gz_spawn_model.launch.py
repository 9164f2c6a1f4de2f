"""Spawns one entity, and starts a bridge for it."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    parts = (("ros_gz_sim", "gz_spawn_model.launch.py"), ("ros_gz_bridge", "ros_gz_bridge.launch.py"))
    return LaunchDescription(
        [
            IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare(package), "launch", name]))
            for package, name in parts
        ]
    )
