"""The droid walks in circles; open a view with config/r2d2.rviz."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    urdf = Path(get_package_share_directory("urdf_tutorial_r2d2")) / "urdf" / "r2d2.urdf.xml"
    use_sim_time = LaunchConfiguration("use_sim_time")
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="false", description="time of a simulation"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                name="robot_state_publisher",
                parameters=[{"use_sim_time": use_sim_time, "robot_description": urdf.read_text()}],
                output="screen",
            ),
            Node(
                package="urdf_tutorial_r2d2",
                executable="state_publisher",
                name="state_publisher",
                output="screen",
            ),
        ]
    )
