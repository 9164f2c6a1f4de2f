"""The name of tb3_loopback_simulation_launch.py in ROS 2 Jazzy."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [IncludeLaunchDescription(str(Path(__file__).with_name("tb3_loopback_simulation_launch.py")))]
    )
