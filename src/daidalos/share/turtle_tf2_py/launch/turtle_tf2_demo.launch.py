"""`turtle_tf2_demo_launch.py` under the name that older tutorials use."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription


def generate_launch_description():
    return LaunchDescription([IncludeLaunchDescription(str(Path(__file__).with_name("turtle_tf2_demo_launch.py")))])
