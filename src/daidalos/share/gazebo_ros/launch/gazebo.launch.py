"""The simulator and the view on it."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    launch = PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(PathJoinSubstitution([launch, "gzserver.launch.py"])),
            IncludeLaunchDescription(PathJoinSubstitution([launch, "gzclient.launch.py"])),
        ]
    )
