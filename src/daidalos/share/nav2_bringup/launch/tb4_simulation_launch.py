"""A simulated TurtleBot 4 that navigates in a depot: simulator, robot, navigation with a map or SLAM, and RViz."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def in_package(package, *parts):
    """Return the path of a file of a package."""
    return PathJoinSubstitution([FindPackageShare(package), *parts])


def generate_launch_description():
    arguments = [
        ("map", in_package("nav2_bringup", "maps", "depot.yaml"), "map file, without SLAM"),
        ("robot_launch", in_package("nav2_minimal_tb4_sim", "launch", "tb4_world.launch.py"), "simulator and robot"),
        ("world", in_package("nav2_minimal_tb4_sim", "worlds", "depot.sdf"), "SDF world to simulate"),
        ("x_pose", "-8.0", "where the robot stands [m]"),
        ("y_pose", "0.0", "where the robot stands [m]"),
    ]
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in arguments),
            IncludeLaunchDescription(str(Path(__file__).with_name("tb3_simulation_launch.py"))),
        ]
    )
