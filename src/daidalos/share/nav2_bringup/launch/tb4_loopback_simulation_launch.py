"""Navigation of a TurtleBot 4 without physics, in the map of a depot, with RViz."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

MODEL = ("urdf", "standard", "turtlebot4.urdf.xacro")


def generate_launch_description():
    model = PathJoinSubstitution([FindPackageShare("nav2_minimal_tb4_description"), *MODEL])
    depot = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "maps", "depot.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("map", default_value=depot, description="map file"),
            DeclareLaunchArgument("model", default_value=model, description="xacro of the robot"),
            IncludeLaunchDescription(str(Path(__file__).with_name("tb3_loopback_simulation_launch.py"))),
        ]
    )
