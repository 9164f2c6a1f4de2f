"""A robot's description on robot_description, and its transforms."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    path = PathJoinSubstitution(
        [FindPackageShare(LaunchConfiguration("urdf_package")), LaunchConfiguration("urdf_package_path")]
    )
    description = ParameterValue(Command(["xacro ", path]), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument("urdf_package", description="package that holds the robot's description"),
            DeclareLaunchArgument("urdf_package_path", description="the description in it, such as urdf/robot.urdf"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
                output="screen",
            ),
        ]
    )
