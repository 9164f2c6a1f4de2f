"""The name of tb3_loopback_simulation_launch.py in ROS 2 Jazzy."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import ThisLaunchFileDir


def generate_launch_description():
    return LaunchDescription([IncludeLaunchDescription([ThisLaunchFileDir(), "/tb3_loopback_simulation_launch.py"])])
