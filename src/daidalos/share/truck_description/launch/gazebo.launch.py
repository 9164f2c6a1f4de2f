"""The truck in its yard; run `diff_drive_publisher` to see it drive an arc."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("truck_description")
    controlled = PathJoinSubstitution([FindPackageShare("humanoid_description"), "launch", "controlled.launch.py"])
    robot = {
        "model": PathJoinSubstitution([here, "urdf", "truck.urdf.xacro"]),
        "name": "truck",
        "z": "0.45",
        "controllers": "joint_state_broadcaster diff_drive_base_controller joint_trajectory_controller",
        "world": LaunchConfiguration("world"),
        "gui": LaunchConfiguration("gui"),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "world",
                default_value=PathJoinSubstitution([here, "worlds", "walled.world"]),
                description="SDF world to simulate",
            ),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(controlled, launch_arguments=robot.items()),
        ]
    )
