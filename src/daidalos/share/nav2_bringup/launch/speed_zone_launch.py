"""The servers of the speed filter's mask and of what it means."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

ARGUMENTS = [
    ("speed_mask", "", "map file of the mask"),
    ("use_speed_zones", "True", "whether they are started"),
]


def generate_launch_description():
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in ARGUMENTS),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("nav2_bringup"), "launch", "zone_launch.py"]),
                launch_arguments={"zone": "speed", "mask": LaunchConfiguration("speed_mask")}.items(),
                condition=IfCondition(LaunchConfiguration("use_speed_zones")),
            ),
        ]
    )
