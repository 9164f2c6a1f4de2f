"""The humanoid in the simulator, its elbows under control; run `joint_publisher` to see it curl its arms."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("humanoid_description")
    controlled = PathJoinSubstitution([FindPackageShare("humanoid_description"), "launch", "controlled.launch.py"])
    robot = {
        "model": PathJoinSubstitution([here, "urdf", "humanoid.urdf.xacro"]),
        "name": "humanoid",
        "z": "0",
        "controllers": "joint_state_broadcaster joint_trajectory_controller",
        "world": LaunchConfiguration("world"),
        "gui": LaunchConfiguration("gui"),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "world",
                default_value=PathJoinSubstitution([here, "worlds", "ball.world"]),
                description="SDF world to simulate",
            ),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(controlled, launch_arguments=robot.items()),
        ]
    )
