"""A tool that follows a curved seam in the simulated cell; the layout `rviz/seam.rviz` shows it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("seam", default_value="curve", description="line, curve or long"),
            DeclareLaunchArgument("controller", default_value="feedforward", description="seam controller"),
            Node(
                package="daidalos_welding",
                executable="seam_servo",
                parameters=[{"seam": LaunchConfiguration("seam"), "controller": LaunchConfiguration("controller")}],
                output="screen",
            ),
        ]
    )
