"""A TurtleBot 4 in the depot."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

MODEL = ("nav2_minimal_tb4_description", "urdf", "standard", "turtlebot4.urdf.xacro")
WORLD = ("nav2_minimal_tb4_sim", "worlds", "depot.sdf")


def in_package(package, *parts):
    """Return the path of a file of a package."""
    return PathJoinSubstitution([FindPackageShare(package), *parts])


def generate_launch_description():
    arguments = [
        ("world", in_package(*WORLD), "SDF world to simulate"),
        ("x_pose", "-8.0", "where the robot stands [m]"),
        ("y_pose", "0.0", "where the robot stands [m]"),
        ("yaw", "0.0", "where it looks [rad]"),
        ("seed", "0", "of all random numbers"),
        ("gui", "true", "whether to serve the studio"),
    ]
    passed = {name: LaunchConfiguration(name) for name, *_ in arguments if name != "gui"}
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in arguments),
            IncludeLaunchDescription(
                in_package("turtlebot3_gazebo", "launch", "turtlebot3_arena.launch.py"),
                launch_arguments={"urdf": in_package(*MODEL), "name": "turtlebot4", **passed}.items(),
            ),
            IncludeLaunchDescription(
                in_package("gazebo_ros", "launch", "gzclient.launch.py"),
                launch_arguments={"gui": LaunchConfiguration("gui")}.items(),
            ),
        ]
    )
